// Beams that deform in shear (Timoshenko), with rotary inertia.
#include <ricochet/scene/assembly.hpp>
#include <utility>

#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// Deep square beam, pinned: NAFEMS FV5.
SceneSpec deep_beam() {
  SceneSpec scene = held_beam(10, {pinned("left", 0), pinned("right", 10)});
  BeamSpec& beam = beam_of(scene);
  beam.young = 2e11;
  beam.density = 8000;
  beam.section = {.type = Section::Type::rectangle, .width = 2, .height = 2};
  beam.shear = BeamShear{0.3, std::nullopt, true};
  return scene;
}

/// ω of the mesh's own motion w_j = W sin(q x_j), θ_j = Θ cos(q x_j), which solves the equations of a pinned beam of
/// equal elements. Its element is integrated here from the static functions w and θ alone, by five Gauss points.
double mesh_pulsation(const UniformPart& part, double length, int elements, int n) {
  const double l = length / elements, a = n * std::numbers::pi / elements, EI = part.section.EI;
  const double phi = 12 * EI / (part.kGA * l * l), c = 1 / (1 + phi);
  Eigen::Matrix4d K = Eigen::Matrix4d::Zero(), M = K;
  constexpr std::array<std::pair<double, double>, 5> gauss = {{{-0.9061798459386640, 0.2369268850561891},
                                                               {-0.5384693101056831, 0.4786286704993665},
                                                               {0, 0.5688888888888889},
                                                               {0.5384693101056831, 0.4786286704993665},
                                                               {0.9061798459386640, 0.2369268850561891}}};
  for (const auto& [at, weight] : gauss) {
    const double x = (at + 1) / 2, dx = weight * l / 2;
    const Eigen::Vector4d w =
        c * Eigen::Vector4d(1 - 3 * x * x + 2 * x * x * x + phi * (1 - x),
                            l * (x - 2 * x * x + x * x * x + phi / 2 * (x - x * x)),
                            3 * x * x - 2 * x * x * x + phi * x, l * (-x * x + x * x * x - phi / 2 * (x - x * x)));
    const Eigen::Vector4d theta = c * Eigen::Vector4d(6 * (x * x - x) / l, 1 - 4 * x + 3 * x * x + phi * (1 - x),
                                                      6 * (x - x * x) / l, 3 * x * x - 2 * x + phi * x);
    const Eigen::Vector4d bend =
        c / l * Eigen::Vector4d(6 * (2 * x - 1) / l, 6 * x - 4 - phi, 6 * (1 - 2 * x) / l, 6 * x - 2 + phi);
    // w' − θ is constant: −φ/(1 + φ) (1/l, 1/2, −1/l, 1/2).
    const Eigen::Vector4d strain = -c * phi * Eigen::Vector4d(1 / l, 0.5, -1 / l, 0.5);
    K += dx * (EI * bend * bend.transpose() + part.kGA * strain * strain.transpose());
    M += dx * (part.section.rhoS * w * w.transpose() + part.rotary * theta * theta.transpose());
  }
  const auto wave = [&](const Eigen::Matrix4d& A) {
    Eigen::Matrix2d out;
    out << A(0, 0) + A(2, 2) + 2 * A(0, 2) * std::cos(a), (A(1, 2) - A(0, 3)) * std::sin(a),
        (A(1, 2) - A(0, 3)) * std::sin(a), A(1, 1) + A(3, 3) + 2 * A(1, 3) * std::cos(a);
    return out;
  };
  const Eigen::Matrix2d k = wave(K), m = wave(M);
  const double two = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0), zero = k(0, 0) * k(1, 1) - k(0, 1) * k(1, 0),
               one = k(0, 0) * m(1, 1) + k(1, 1) * m(0, 0) - 2 * k(0, 1) * m(0, 1);
  return std::sqrt(2 * zero / (one + std::sqrt(one * one - 4 * two * zero)));
}

}  // namespace

TEST_CASE("functions of an element in shear: rigid motions, w' = θ + constant strain, derivatives") {
  FiniteElementSpace::Element element;
  element.length = 0.3;
  element.shear = 1.7;
  const auto basis = FiniteElementSpace::Basis::hermite;
  CHECK(shape_values(basis, element, 0) == std::array<double, 4>{1, 0, 0, 0});
  CHECK(shape_values(basis, element, 1) == std::array<double, 4>{0, 0, 1, 0});
  const double d = 1e-5;
  std::array<double, 4> strain_before{};
  for (const double xi : {0.1, 0.5, 0.87}) {
    const auto w = shape_values(basis, element, xi), theta = shape_rotations(element, xi);
    const auto slope = shape_slopes(element, xi), bend = shape_strains(basis, element, xi);
    CHECK(w[0] + w[2] == Approx(1).epsilon(1e-14));
    CHECK(w[2] * 0.3 + w[1] + w[3] == Approx(0.3 * xi).epsilon(1e-14));
    CHECK(theta[0] + theta[2] == Approx(0).margin(1e-14));
    CHECK(theta[2] * 0.3 + theta[1] + theta[3] == Approx(1).epsilon(1e-14));
    const auto after = shape_values(basis, element, xi + d), before = shape_values(basis, element, xi - d);
    const auto turned = shape_rotations(element, xi + d), turned_before = shape_rotations(element, xi - d);
    for (std::size_t a = 0; a < 4; ++a) {
      // Central differences of cubics: d² of the third derivative, and round-off over d.
      CHECK(slope[a] == Approx((after[a] - before[a]) / (2 * d * 0.3)).margin(1e-7));
      CHECK(bend[a] == Approx((turned[a] - turned_before[a]) / (2 * d * 0.3)).margin(1e-7));
      if (xi > 0.1) CHECK(slope[a] - theta[a] == Approx(strain_before[a]).margin(1e-13));
      strain_before[a] = slope[a] - theta[a];
    }
  }
}

TEST_CASE("K in shear is the integral of EI θ'θ' + kGA (w' − θ)²") {
  const SceneSpec scene = deep_beam();
  const BeamSpec& beam = std::get<BeamSpec>(scene.structure);
  const FiniteElementSpace space = beam_space(beam, 6);
  const UniformPart part = uniform_parts(beam).front();
  CHECK(part.kGA == Approx(10 * 1.3 / (12 + 3.3) * 2e11 / 2.6 * 4).epsilon(1e-14));  // Cowper
  Eigen::MatrixXd integrated = Eigen::MatrixXd::Zero(space.dofs, space.dofs);
  for (const auto& element : space.elements)
    for (const auto& [xi, weight] : gauss_points()) {
      const auto bend = shape_strains(space.basis, element, xi), slope = shape_slopes(element, xi),
                 theta = shape_rotations(element, xi);
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
          if (element.dof[a] >= 0 && element.dof[b] >= 0)
            integrated(element.dof[a], element.dof[b]) +=
                element.length * weight *
                (part.section.EI * bend[a] * bend[b] + part.kGA * (slope[a] - theta[a]) * (slope[b] - theta[b]));
    }
  const Eigen::MatrixXd K = beam_stiffness(beam, space);
  // Sums of eight products: a few ulps of the largest entry.
  CHECK((K - integrated).cwiseAbs().maxCoeff() <= 1e-13 * K.cwiseAbs().maxCoeff());
}

TEST_CASE("nodal values are exact in statics with shear: the middle of a pinned beam under a point force") {
  SceneSpec scene = deep_beam();
  scene.load.terms = {{.force = true, .at = 5.0, .shape = Formula(), .history = Formula(1e6)}};
  const UniformPart part = uniform_parts(beam_of(scene)).front();
  for (const int elements : {2, 8}) {
    const SemiDiscrete problem = discretised(scene, elements, *mass("consistent"));
    Eigen::VectorXd F(problem.dofs());
    problem.load->assemble(0, F.data());
    const double w = (displacement_rows(problem.space, {5}) * eigen::ldlt_solve(problem.stiffness, F))(0);
    // PL³/48EI + PL/4kGA.
    CHECK(w == Approx(1e6 * 1000 / (48 * part.section.EI) + 1e6 * 10 / (4 * part.kGA)).epsilon(1e-11));
  }
}

TEST_CASE("a deep pinned beam: the roots of Timoshenko's frequency equation, with order 2 (NAFEMS FV5)") {
  const UniformPart part = uniform_parts(beam_of(deep_beam())).front();
  const double EI = part.section.EI, rhoA = part.section.rhoS, rhoI = part.rotary;
  std::vector<double> before;
  for (const int elements : {20, 40, 80}) {
    const Eigen::VectorXd found = pulsations(deep_beam(), elements);
    for (int n = 1; n <= 3; ++n) {
      // ρI ρA/kGA ω⁴ − (ρA + ρI q² + EI ρA q²/kGA) ω² + EI q⁴ = 0, q = nπ/L; its lower root.
      const double q = n * std::numbers::pi / 10, a = rhoI * rhoA / part.kGA, c = EI * std::pow(q, 4),
                   b = rhoA + rhoI * q * q + EI * rhoA / part.kGA * q * q;
      const double exact = std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a));
      const double error = found[n - 1] / exact - 1;
      CHECK(error > 0);
      if (elements == 20)
        before.push_back(error);
      else
        CHECK(std::exchange(before[static_cast<std::size_t>(n - 1)], error) / error == Approx(4).epsilon(0.1));
    }
  }
  // Published: 42.650, 148.15 and 283.47 Hz.
  const Eigen::VectorXd fine = pulsations(deep_beam(), 80) / (2 * std::numbers::pi);
  CHECK(fine[0] == Approx(42.645).epsilon(3e-4));
  CHECK(fine[1] == Approx(148.149).epsilon(3e-4));
  CHECK(fine[2] == Approx(283.468).epsilon(3e-4));
}

TEST_CASE("a mesh of a deep pinned beam has the frequencies of its own wave equation") {
  const UniformPart part = uniform_parts(beam_of(deep_beam())).front();
  for (const int elements : {10, 40}) {
    const Eigen::VectorXd found = pulsations(deep_beam(), elements);
    // Eigenvalues of matrices whose entries span eight decades.
    for (int n = 1; n <= 3; ++n) CHECK(found[n - 1] == Approx(mesh_pulsation(part, 10, elements, n)).epsilon(1e-9));
  }
  // Mode 3 of 40 elements stands 9.5e-4 above the beam's 283.468 Hz: the strain of shear is constant in an element.
  CHECK(mesh_pulsation(part, 10, 40, 3) / (2 * std::numbers::pi) == Approx(283.73863).epsilon(1e-7));
}

TEST_CASE("a uniform load on a deep beam: 5qL⁴/384EI + qL²/8kGA, 0.5361 mm in NAFEMS 5T") {
  SceneSpec scene = deep_beam();
  scene.load = Formula(1e6);
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  Eigen::VectorXd F(problem.dofs());
  problem.load->assemble(0, F.data());
  const double w = (displacement_rows(problem.space, {5}) * eigen::ldlt_solve(problem.stiffness, F))(0);
  const UniformPart part = uniform_parts(beam_of(scene)).front();
  CHECK(w == Approx(5e10 / (384 * part.section.EI) + 1e8 / (8 * part.kGA)).epsilon(1e-11));
  CHECK(w == Approx(0.5361e-3).epsilon(1e-4));
}

TEST_CASE("shear of a slender beam vanishes with its slenderness, and a stiff factor is none") {
  SceneSpec scene = deep_beam();
  BeamSpec& beam = beam_of(scene);
  beam.shear->rotary = false;
  beam.shear->factor = 1e9;
  const double stiff = pulsations(scene, 20)[0];
  beam.shear = std::nullopt;
  CHECK(stiff == Approx(pulsations(scene, 20)[0]).epsilon(1e-8));
}

TEST_CASE("static modes in shear sum to the translation, sections given by numbers have no area") {
  SceneSpec scene = deep_beam();
  beam_of(scene).supports = {clamped("a", 0), pinned("b", 4), elastic("c", 10, 1e8)};
  const SemiDiscrete problem = discretised(scene, 20, *mass("consistent"));
  CHECK((problem.support_loads.rowwise().sum() - problem.support_shape).norm() <= 1e-9 * problem.support_shape.norm());
  beam_of(scene).section = {.type = Section::Type::given, .EI = 1, .rhoS = 1};
  CHECK(input_error([&] { check_scene(scene, 4); }).find("has no area for shear") != std::string::npos);
  beam_of(scene).shear->poisson = 0.7;
  CHECK(input_error([&] { check_scene(scene, 4); }).starts_with("/scene/structure/shear/poisson"));
}
