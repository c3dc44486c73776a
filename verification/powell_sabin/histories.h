// What the figures of the Powell-Sabin thesis share: curves over time with their reference, and single
// numbers.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "app/verification.h"
#include "verification/powell_sabin/strip.h"

namespace wisp::powell_sabin {

/// A number without a published counterpart.
VerificationRow number(const std::string& case_name, const std::string& quantity, double computed);
/// The same with a verdict that counts.
VerificationRow bound(const std::string& case_name, const std::string& quantity, double computed, bool kept);

/// Writes NAME-displacement and NAME-velocity: the middle point of named runs, which may have ended early,
/// and the reference.
void write_history(const VerificationRequest& request, const std::string& name, const std::string& title,
                   const std::vector<std::pair<std::string, StripRun>>& runs, const Reference& reference,
                   const std::string& reference_name);

}  // namespace wisp::powell_sabin
