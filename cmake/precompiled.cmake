# Precompiled headers of what nearly every file includes: a third of an optimised build from nothing, a twentieth of one
# without optimisation. For builds without a compiler cache, such as those of continuous integration: caches cannot store
# what was compiled with them.
option(WISP_PRECOMPILE "Precompile the headers of Eigen, fmt, the standard library and the model" OFF)

# wisp_precompiled(NAME HEADER...): a library that has them, for targets of the same options.
function(wisp_precompiled name)
  add_library(${name} STATIC ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name} PRIVATE wisp_options Eigen3::Eigen fmt::fmt spdlog::spdlog PkgConfig::PETSC PkgConfig::TOML)
  target_precompile_headers(${name} PRIVATE
    <algorithm> <array> <cmath> <filesystem> <functional> <memory> <optional> <span> <string> <string_view> <tuple>
    <variant> <vector> <Eigen/Core> <Eigen/Geometry> <fmt/format.h> ${ARGN})
endfunction()
# wisp_use_precompiled(TARGET NAME): nothing where they are switched off.
function(wisp_use_precompiled target name)
  if(WISP_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()
