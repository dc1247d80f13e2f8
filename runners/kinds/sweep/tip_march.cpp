#include "runners/kinds/sweep/tip_march.hpp"

namespace ricochet {

TipMarch::TipMarch(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan)
    : marcher_(std::move(program)), begin_(plan.strobe + 1), before_(orbits.size()) {
  turn_back();
  for (const Orbit* orbit : orbits) {
    const int lane = static_cast<int>(at_.size());
    marcher_.set_lane(lane, orbit->lane, orbit->entry);
    at_.push_back(marcher_.tip(lane));
  }
}

void TipMarch::march(long long steps, const Use& use) {
  for (long long made = 0; made < steps; ++made, ++made_) {
    marcher_.march(1);
    for (std::size_t lane = 0; lane < at_.size(); ++lane) {
      const double after = marcher_.tip(static_cast<int>(lane));
      if (made_ > 1) use(lane, made_, at_[lane], (after - before_[lane]) / (2 * h()));
      before_[lane] = at_[lane];
      at_[lane] = after;
    }
  }
}

}  // namespace ricochet
