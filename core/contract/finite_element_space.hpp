#pragma once
#include <array>
#include <string>
#include <vector>

namespace ricochet {

/// The displacement space, as mass strategies need it: elements with local shape functions, and point masses.
///
/// Basis on an element [a, a+ℓ], ξ = (x−a)/ℓ in [0,1]:
///   hermite  (4 functions, dofs w_a, w'_a, w_b, w'_b): 1−3ξ²+2ξ³, ℓ(ξ−2ξ²+ξ³), 3ξ²−2ξ³, ℓ(ξ³−ξ²)
///   linear   (2 functions): 1−ξ, ξ
/// Dofs eliminated by a boundary condition are −1. Lengths in m, line density ρS in kg/m.
struct FiniteElementSpace {
  enum class Basis { hermite, linear };
  struct Element {
    double left = 0, length = 0, line_density = 0;
    std::array<int, 4> dof{-1, -1, -1, -1};
  };
  struct PointMass {
    int dof = 0;
    double mass = 0;  ///< kg
  };
  std::string structure;  ///< "beam", "bar", "oscillator": for sentences only
  Basis basis = Basis::hermite;
  int dofs = 0;                   ///< n
  std::vector<Element> elements;  ///< ordered in x
  std::vector<PointMass> point_masses;
  bool left_fixed = false, right_fixed = false;  ///< displacement imposed at the ends: velocities vanish there too
  /// Where a stop may push: the dofs of the columns of H that are not zero, in order, each once (of a contact point on
  /// a node, its displacement; of one inside an element, all dofs of that element). Empty where no stop stands. For
  /// strategies that leave such dofs without inertia; whether a contact law acts there is not known here.
  std::vector<int> contact_dofs;

  int functions() const { return basis == Basis::hermite ? 4 : 2; }
};

/// Values of the local shape functions at ξ in [0,1]; unused entries are 0.
std::array<double, 4> shape_values(FiniteElementSpace::Basis basis, double length, double xi);
/// Second (hermite) or first (linear) derivatives in x: what the elastic energy integrates.
std::array<double, 4> shape_strains(FiniteElementSpace::Basis basis, double length, double xi);

/// Gauss–Legendre on [0,1] with 4 points: exact for polynomials of degree 7, hence for every product integrated here.
struct GaussPoint {
  double xi, weight;
};
const std::array<GaussPoint, 4>& gauss_points();

}  // namespace ricochet
