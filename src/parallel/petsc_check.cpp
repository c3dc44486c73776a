#include "parallel/petsc_check.h"

#include <string>

#include "core/error.h"

namespace wisp {
namespace {

std::string first_message;

// PETSc calls this once where the error starts and again on each level of its call stack: the first text is
// the cause.
PetscErrorCode keep_message(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL) {
    first_message = function != nullptr ? std::string(function) + ": " : std::string();
    if (message != nullptr) first_message += message;
  }
  return code;
}

}  // namespace

void keep_petsc_errors() { petsc(PetscPushErrorHandler(keep_message, nullptr)); }

void throw_petsc_error(PetscErrorCode code) {
  const char* meaning = nullptr;
  if (PetscErrorMessage(code, &meaning, nullptr) != 0) meaning = nullptr;
  std::string text = meaning != nullptr ? std::string(meaning) : "error code " + std::to_string(code);
  if (!first_message.empty()) text += " (" + first_message + ")";
  first_message.clear();
  // One line each: PETSc breaks its longer messages.
  for (char& c : text)
    if (c == '\n') c = ' ';
  run_error("PETSc: {}", text);
}

}  // namespace wisp
