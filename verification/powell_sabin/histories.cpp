#include "verification/powell_sabin/histories.h"

#include <cmath>

#include "verification/published.h"

namespace wisp::powell_sabin {

VerificationRow number(const std::string& case_name, const std::string& quantity, double computed) {
  VerificationRow row;
  row.case_name = case_name, row.quantity = quantity, row.computed = computed;
  return row;
}

VerificationRow bound(const std::string& case_name, const std::string& quantity, double computed, bool kept) {
  VerificationRow row = number(case_name, quantity, computed);
  row.gated = true, row.verdict = kept;
  return row;
}

void write_history(const VerificationRequest& request, const std::string& name, const std::string& title,
                   const std::vector<std::pair<std::string, StripRun>>& runs, const Reference& reference,
                   const std::string& reference_name) {
  std::vector<FigureColumn> u{{"t [s]", reference.time}}, v{{"t [s]", reference.time}};
  for (const auto& [label, run] : runs) {
    FigureColumn cu{label + ": displacement [m]", run.displacement},
        cv{label + ": velocity [m/s]", run.velocity};
    cu.values.resize(reference.time.size(), std::nan("")),
        cv.values.resize(reference.time.size(), std::nan(""));
    u.push_back(cu), v.push_back(cv);
  }
  u.push_back({reference_name, reference.displacement}), v.push_back({reference_name, reference.velocity});
  write_curves(request.folder, name + "-displacement", title, u);
  write_curves(request.folder, name + "-velocity", title, v);
}

}  // namespace wisp::powell_sabin
