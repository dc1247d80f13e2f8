#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/comparison/comparison.hpp"
#include "runners/kinds/comparison/comparison_answers.hpp"

namespace ricochet {

namespace {

class ConvergenceKind final : public ComparisonKind {
 public:
  ConvergenceKind()
      : ComparisonKind("convergence", "Each case is compared with a reference, and orders are fitted to the errors.",
                       comparison_keys(), comparison_measures()) {}
  answers::Answer answers(const StudyResults& results) const override {
    return orders_answer(answers::Compared(results));
  }
  report::KindPage page() const override { return report::comparison_page(); }
};

}  // namespace

KindPointer convergence_kind() {
  return std::make_unique<ConvergenceKind>();
}

}  // namespace ricochet
