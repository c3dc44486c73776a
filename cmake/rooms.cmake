# One static library per room (folder of src/). Sources are found by pattern, so that a new file needs no edit here.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET PETSc)
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET SLEPc)
pkg_check_modules(MPI REQUIRED IMPORTED_TARGET ompi-cxx)
pkg_check_modules(TOML REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi)
pkg_check_modules(QHULL REQUIRED IMPORTED_TARGET qhull_r)

# The interpreter that has NumPy and Matplotlib (Debian's), not whichever comes first on the path.
find_program(WISP_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT WISP_PYTHON)
  find_program(WISP_PYTHON NAMES python3 REQUIRED)
endif()

# Headers of other projects are SYSTEM, or -Wconversion would stop on them.
foreach(target PETSC SLEPC MPI TOML HDF5)
  get_target_property(dirs PkgConfig::${target} INTERFACE_INCLUDE_DIRECTORIES)
  if(dirs)
    set_target_properties(PkgConfig::${target} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${dirs}")
  endif()
  # Debian's flags carry -I and -D_FORTIFY_SOURCE, which warns in builds without optimisation.
  set_property(TARGET PkgConfig::${target} PROPERTY INTERFACE_COMPILE_OPTIONS "")
endforeach()
foreach(target PETSC SLEPC)
  target_link_libraries(PkgConfig::${target} INTERFACE PkgConfig::MPI)
endforeach()
add_library(wisp_boost INTERFACE)

include(cmake/precompiled.cmake)
add_library(wisp_options INTERFACE)
target_compile_options(wisp_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 sees uninitialised values in its own AVX-512 header (GCC bug 105593), overlaps in sums of strings (105651).
  target_compile_options(wisp_options INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized -Wno-restrict)
  if(WISP_PRECOMPILE)  # and overflows in the standard library's strings, which it takes for ours from such headers
    target_compile_options(wisp_options INTERFACE -Wno-stringop-overflow -Wno-array-bounds)
  endif()
endif()
target_compile_definitions(wisp_options INTERFACE OMPI_SKIP_MPICXX PETSC_SKIP_CXX_COMPLEX_FIX
  TOML_HEADER_ONLY=0 TOML_SHARED_LIB=1)  # toml++ is a shared library here; its flags were dropped above
target_compile_definitions(wisp_options INTERFACE
  WISP_SPLINE_DEGREE_2D=${WISP_SPLINE_DEGREE_2D} WISP_SPLINE_DEGREE_3D=${WISP_SPLINE_DEGREE_3D})
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  # No -ffast-math: results must not depend on the compiler's mood. These two only drop errno and signalling NaNs.
  target_compile_options(wisp_options INTERFACE -fno-math-errno -fno-trapping-math)
endif()
if(WISP_NATIVE)
  target_compile_options(wisp_options INTERFACE -march=native)
endif()
if(WISP_SANITIZE)
  target_compile_options(wisp_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                -fno-omit-frame-pointer -g1)
  # Two checks before every access to memory that take a third of the time to compile: what they find ends in a
  # report of the address sanitizer (null), or in Eigen's own assertion (alignment).
  target_compile_options(wisp_options INTERFACE -fno-sanitize=null,alignment)
  target_link_options(wisp_options INTERFACE -fsanitize=address,undefined)
  # Without optimisation these attributes still copy a kernel with all its checks into every caller: three times the
  # time to compile room transfer, and 2 GB for one file.
  target_compile_definitions(wisp_options INTERFACE always_inline=unused flatten=unused)
endif()

if(WISP_PRECOMPILE)
  wisp_precompiled(wisp_precompiled)
  wisp_precompiled(wisp_precompiled_model  # for the rooms that use the grid
    ${PROJECT_SOURCE_DIR}/src/analysis/model.h ${PROJECT_SOURCE_DIR}/src/io/case.h)
endif()

set(WISP_ROOMS "" CACHE INTERNAL "")
function(wisp_room name layer)
  cmake_parse_arguments(ROOM "" "" "ROOMS;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  list(TRANSFORM ROOM_ROOMS PREPEND wisp_)
  if(sources)
    add_library(wisp_${name} STATIC ${sources})
    if(layer GREATER 2)
      wisp_use_precompiled(wisp_${name} wisp_precompiled_model)
    else()
      wisp_use_precompiled(wisp_${name} wisp_precompiled)
    endif()
    set(scope PUBLIC)
  else()
    add_library(wisp_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(wisp_${name} ${scope} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(wisp_${name} ${scope} wisp_options ${ROOM_ROOMS} ${ROOM_LIBRARIES})
  set(WISP_ROOMS ${WISP_ROOMS} ${name} CACHE INTERNAL "")
endfunction()

# verification/<paper>/*.cpp are compiled into the program, above every room.
function(wisp_verification)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/verification/*/*.cpp ${PROJECT_SOURCE_DIR}/verification/*.cpp)
  if(sources)
    add_library(wisp_verification STATIC ${sources})
    wisp_use_precompiled(wisp_verification wisp_precompiled_model)
    target_include_directories(wisp_verification PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(wisp_verification PUBLIC wisp_app)
  endif()
endfunction()

function(wisp_program)
  if(EXISTS ${PROJECT_SOURCE_DIR}/verification/main.cc)
    add_executable(wisp ${PROJECT_SOURCE_DIR}/verification/main.cc)
    target_link_libraries(wisp PRIVATE wisp_app)
    if(TARGET wisp_verification)
      target_link_libraries(wisp PRIVATE wisp_verification)
    else()
      target_sources(wisp PRIVATE ${PROJECT_SOURCE_DIR}/tests/sanitize/no_tables.cc)
      target_include_directories(wisp PRIVATE ${PROJECT_SOURCE_DIR})
    endif()
  endif()
endfunction()
