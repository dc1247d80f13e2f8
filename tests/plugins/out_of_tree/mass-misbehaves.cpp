// A consistent mass, spoilt in the way that its parameter says.
#include <limits>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

class Misbehaves final : public MassStrategy {
 public:
  explicit Misbehaves(std::string how) : how_(std::move(how)) {}
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    if (how_ == "throw-int") throw 42;
    if (how_ == "empty-refusal") return Refusal{" "};
    Inertia inertia;
    inertia.mass = consistent_mass(space);
    SparseMatrix& mass = inertia.mass;
    if (how_ == "empty") mass.resize(0, 0);
    if (how_ == "small") mass.conservativeResize(2, 2);
    if (how_ == "not-a-number") mass.coeffRef(0, 0) = std::numeric_limits<double>::quiet_NaN();
    if (how_ == "negative") mass = -mass;
    if (how_ == "indefinite") mass.coeffRef(0, 1) = mass.coeffRef(1, 0) = 2 * mass.coeff(0, 0);
    if (how_ == "unsymmetric") mass.coeffRef(0, 2) *= 1.5;
    if (how_ == "kernel") inertia.kernel_dimension = 3;
    if (how_ == "hidden-kernel") mass = mass * 0.0;
    return inertia;
  }

 private:
  std::string how_;
};

void register_all(Registry& registry) {
  registry.add_mass({.name = "misbehaves",
                     .summary = "A mass that is none.",
                     .text = "It is spoilt as told.",
                     .source = "none",
                     .parameters = {word_parameter("how",
                                                   {"throw-int", "empty-refusal", "empty", "small", "not-a-number",
                                                    "negative", "indefinite", "unsymmetric", "kernel", "hidden-kernel"},
                                                   "negative", "the way")}},
                    [](const Parameters& p) { return std::make_unique<Misbehaves>(p.word("how")); });
}

}  // namespace

RICOCHET_PLUGIN(mass, misbehaves, register_all)
