// What a case file says about the mass of an explicit step.
#pragma once
#include "core/describe.h"

namespace wisp {

enum class Mass { lumped, consistent, partial, fmpm };
template <>
inline constexpr auto choices<Mass> = choice_list<Mass>({{"lumped", Mass::lumped},
                                                         {"consistent", Mass::consistent},
                                                         {"partial", Mass::partial},
                                                         {"fmpm", Mass::fmpm}});

/// How M x = b is understood where functions may hang on the tip of a domain.
struct MassTreatment {
  Mass mass = Mass::lumped;
  int fmpm_order = 4;             ///< k of FMPM(k)
  double deactivate_below = 0.0;  ///< kg: functions with M_ii below it take no part
};

}  // namespace wisp
