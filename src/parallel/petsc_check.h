// PETSc's error codes become exceptions.
#pragma once
#include <petscsys.h>

namespace wisp {

/// Throws the error that PETSc just reported: its first message, the routine it came from and what the code
/// means.
[[noreturn]] void throw_petsc_error(PetscErrorCode code);

/// Makes PETSc keep the text of an error for `petsc()` instead of printing a trace. Called once by `Session`.
void keep_petsc_errors();

/// Checks the code that a PETSc or SLEPc call returned.
/// @throws RunError with PETSc's own message when the call failed.
inline void petsc(PetscErrorCode code) {
  if (code != 0) [[unlikely]]
    throw_petsc_error(code);
}

}  // namespace wisp
