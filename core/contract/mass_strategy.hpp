#pragma once
#include <Eigen/SparseCore>
#include <array>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <variant>
#include <vector>

namespace ricochet {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The mass of a structure without elements, given by its matrices or marched in its modes. What else is known of its
/// dofs stands beside it.
struct GivenMass {
  SparseMatrix mass;            ///< M, n × n, both triangles, positive semidefinite
  SparseMatrix stiffness = {};  ///< K, n × n: dofs that share an entry are neighbours
  /// Of each dof: 0, 1, 2 a displacement along x, y, z; 3 a rotation; −1 anything else.
  std::vector<int> direction = {};
  Eigen::MatrixXd rigid = {};  ///< n × k: the translations of the dofs, then the rotations that K lets be
  /// Along x, y, z (kg): what a translation of all dofs moves, and the sum of the diagonal of M, held dofs included.
  std::array<double, 3> translated{}, diagonal{};
  bool modes = false;              ///< whether the dofs are coordinates of modes: nothing but `mass` is known then
  std::vector<int> attached = {};  ///< of those, the coordinates of the residual flexibility of stops
  bool attached_mass = true;       ///< whether `mass` says what inertia these have
};

/// The displacement space, as mass strategies need it: elements with local shape functions, and point masses.
///
/// Basis on an element [a, a+ℓ], ξ = (x−a)/ℓ in [0,1]:
///
///     hermite  (4 functions, dofs w_a, w'_a, w_b, w'_b): 1−3ξ²+2ξ³, ℓ(ξ−2ξ²+ξ³), 3ξ²−2ξ³, ℓ(ξ³−ξ²)
///     linear   (2 functions): 1−ξ, ξ
///
/// With shear deformation, φ = 12EI/(kGAℓ²) > 0, the dofs are (w, θ). The functions are those of a beam loaded at its
/// ends:
///
///     w: (1+φ)⁻¹ [1−3ξ²+2ξ³+φ(1−ξ), ℓ(ξ−2ξ²+ξ³+φ(ξ−ξ²)/2), 3ξ²−2ξ³+φξ, ℓ(ξ³−ξ²−φ(ξ−ξ²)/2)]
///
/// Dofs eliminated by a support, at an end or between, are −1. Lengths in m, line density ρS in kg/m; elements need not
/// be equal.
struct FiniteElementSpace {
  enum class Basis { hermite, linear };
  struct Element {
    double left = 0, length = 0, line_density = 0;
    std::array<int, 4> dof{-1, -1, -1, -1};
    double shear = 0;   ///< φ; 0: slopes are rotations
    double rotary = 0;  ///< ρI, kg m, inertia of the cross-section against rotation; 0: none
  };
  struct PointMass {
    int dof = 0;
    double mass = 0;        ///< kg; kg m² on a rotation
    bool rotation = false;  ///< whether the dof is a rotation, which a rigid translation does not move
  };
  std::string structure;  ///< "beam", "bar", "oscillator", "assembled structure": for sentences only
  Basis basis = Basis::hermite;
  int dofs = 0;                   ///< n
  std::vector<Element> elements;  ///< ordered in x
  std::vector<PointMass> point_masses;
  bool left_fixed = false, right_fixed = false;  ///< displacement imposed at the ends: velocities vanish there too
  /// Where a stop may push: the dofs whose columns of H are not zero, in order, each once. A contact point on a node
  /// gives its displacement, one inside an element all dofs of that element. Empty where no stop stands. For strategies
  /// that leave such dofs without inertia; whether a contact law acts there is not known here.
  std::vector<int> contact_dofs;
  std::optional<GivenMass> given;  ///< of matrices that are given: then there are no elements
  /// Of a beam in two planes, the same elements as they bend across (along z), with dofs of their own. A mass strategy
  /// is asked for one plane at a time, and sees none.
  std::vector<Element> across = {};

  int functions() const { return basis == Basis::hermite ? 4 : 2; }
};

/// Values of the local shape functions at ξ in [0,1]; unused entries are 0.
std::array<double, 4> shape_values(FiniteElementSpace::Basis basis, double length, double xi);
/// Second (hermite) or first (linear) derivatives in x: what the elastic energy integrates.
std::array<double, 4> shape_strains(FiniteElementSpace::Basis basis, double length, double xi);
/// The same of an element that may deform in shear; strains are then θ', rotations θ.
std::array<double, 4> shape_values(FiniteElementSpace::Basis basis, const FiniteElementSpace::Element& element,
                                   double xi);
std::array<double, 4> shape_strains(FiniteElementSpace::Basis basis, const FiniteElementSpace::Element& element,
                                    double xi);
/// θ of Hermite functions, w' without shear; and w' itself.
std::array<double, 4> shape_rotations(const FiniteElementSpace::Element& element, double xi);
std::array<double, 4> shape_slopes(const FiniteElementSpace::Element& element, double xi);

/// Gauss–Legendre on [0,1] with 4 points: exact for polynomials of degree 7, hence for every product integrated here.
struct GaussPoint {
  double xi, weight;
};
const std::array<GaussPoint, 4>& gauss_points();

/// The mass matrix, symmetric positive semidefinite, in one of three forms; the matrices of the others stay empty
/// (0×0):
///
///     assembled:  M as a sparse n × n matrix (both triangles stored)
///     factored:   M = Bᵀ C_v⁻¹ B with B (N_v × n), B_ij = ∫ρS ψ_i φ_j, C_v (N_v × N_v, SPD) = ∫ρS ψψ
///     inverse:    M⁻¹ as a sparse n × n matrix, SPD (both triangles stored)
///
/// Factored serves where C_v⁻¹ is full and M must never be formed on the marching path. Inverse serves where M is full:
/// an explicit stage is then a product with it.
struct Inertia {
  SparseMatrix mass;           ///< M
  SparseMatrix coupling;       ///< B
  SparseMatrix velocity_mass;  ///< C_v
  SparseMatrix inverse;        ///< M⁻¹
  int kernel_dimension = 0;    ///< dim Ker M; 0 of the inverse form
  bool factored() const { return coupling.rows() > 0; }
  bool inverted() const { return inverse.rows() > 0; }
  bool assembled() const { return !factored() && !inverted(); }
};

/// B and C_v of an inertia that is not assembled; those of the inverse form are I and M⁻¹.
struct MassFactors {
  SparseMatrix coupling, velocity_mass;
};
MassFactors mass_factors(const Inertia& inertia);

using InertiaOrRefusal = std::variant<Inertia, Refusal>;

/// How velocities are discretised, hence the mass matrix.
class MassStrategy {
 public:
  virtual ~MassStrategy() = default;
  virtual InertiaOrRefusal build(const FiniteElementSpace& space) const = 0;
  /// Whether it makes a mass of matrices that are given (FiniteElementSpace::given); where not, it is not asked.
  virtual bool takes_given() const { return false; }
  /// The same of matrices in coordinates of modes (GivenMass::modes).
  virtual bool takes_modes() const { return false; }
};

/// M_ij = ∫ρS φ_i φ_j + ρI θ_i θ_j dx: the consistent matrix of the space, point masses included; of matrices that are
/// given, M itself.
SparseMatrix consistent_mass(const FiniteElementSpace& space);

/// Rank of a symmetric positive semidefinite A (n × n): how many eigenvalues of D A D are above 1e-11. The scales D =
/// diag(A)^{-1/2} make units count for nothing. By Sylvester's law of inertia the rank is the number of positive pivots
/// of D A D − 1e-11 I = L Δ Lᵀ. It costs one sparse factorisation, in the order given of a narrow band. The ranks of the
/// matrices that were asked for last are kept.
int semidefinite_rank(const SparseMatrix& A);

/// Rank of B (any shape): that of B̂ B̂ᵀ, where B̂ has the columns of B scaled to length 1. Singular values below 3e-6
/// count as zero, with the rows of B̂ scaled to length 1 as well.
int row_rank(const SparseMatrix& B);

}  // namespace ricochet
