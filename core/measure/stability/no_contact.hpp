#pragma once
#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

/// What stops do is not asked: no contact at all.
class NoContact final : public ContactLaw {
 public:
  bool absent() const override { return true; }
  void prepare(int, std::span<const Parameters>) override {}
  void solve(ReducedProblem&) override {}
};

}  // namespace ricochet
