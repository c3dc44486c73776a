// PETSc's objects as values that free themselves.
#pragma once
#include <petscksp.h>

#include <utility>

#include "parallel/petsc_check.h"

namespace wisp {

/// Silences PETSc's own printing of errors while it lives: errors then only come back as codes.
class QuietPetsc {
 public:
  QuietPetsc() { PetscPushErrorHandler(PetscReturnErrorHandler, nullptr); }
  ~QuietPetsc() { PetscPopErrorHandler(); }
  QuietPetsc(const QuietPetsc&) = delete;
  QuietPetsc& operator=(const QuietPetsc&) = delete;
};

/// Owner of one PETSc object.
template <class T, PetscErrorCode (*destroy)(T*)>
class PetscOwner {
 public:
  PetscOwner() = default;
  ~PetscOwner() { reset(); }
  PetscOwner(PetscOwner&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  PetscOwner& operator=(PetscOwner&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  T get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }
  /// Frees the object and returns the place for a new one: `MatCreate(comm, m.renew())`.
  T* renew() {
    reset();
    return &object_;
  }
  void reset() {
    PetscBool finished = PETSC_FALSE;  // an object that outlives PetscFinalize is already gone
    if (object_ && PetscFinalized(&finished) == 0 && !finished) destroy(&object_);
    object_ = nullptr;
  }

 private:
  T object_ = nullptr;
};

using OwnedMat = PetscOwner<::Mat, MatDestroy>;
using OwnedVec = PetscOwner<::Vec, VecDestroy>;
using OwnedKsp = PetscOwner<::KSP, KSPDestroy>;

}  // namespace wisp
