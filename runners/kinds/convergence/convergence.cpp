#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"

namespace ricochet {

namespace {

class ConvergenceKind final : public ComparisonKind {
 public:
  ConvergenceKind()
      : ComparisonKind("convergence", "Each case is compared with a reference, and orders are fitted to the errors.",
                       comparison_keys(), comparison_measures(), {"order"}, default_order_asks) {}
  Analysis analysis(StudyResults& results, const Choices& study) const override {
    put_tables(results, study);
    return {report::comparison_page(), {{"order", order_ask}}};
  }
};

}  // namespace

KindPointer convergence_kind() {
  return std::make_unique<ConvergenceKind>();
}

}  // namespace ricochet
