#pragma once
#include <Eigen/Core>
#include <memory>
#include <random>
#include <ricochet/contract/contact_law.hpp>
#include <vector>

#include "runners/check/checks.hpp"
#include "runners/check/guarded_memory.hpp"

/// \file
/// What is looked at in a contact law.
namespace ricochet::checking {

// Contact problems to which a law is put directly, without scheme or structure.

using Law = Subject<ContactLaw>;

/// A dense Delassus operator. Its columns may only be read.
class DenseDelassus final : public DelassusColumns {
 public:
  explicit DenseDelassus(Eigen::MatrixXd matrix);
  const double* column(int j) override { return &(*shown_)[j * matrix_.rows()]; }
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  Eigen::MatrixXd matrix_;
  std::shared_ptr<GuardedArray<double>> shown_;
};

/// What one lane asks: m numbers each.
struct LaneProblem {
  Eigen::VectorXd free, lower, upper, rate, before, effort;
};

/// A block of lanes before a law, and what the law answers. Nothing allocates between asking and answer. The law is
/// given arrays that are guarded: what it touches beyond them, or writes where it may only read, is a
/// std::runtime_error.
class LawBench {
 public:
  /// Makes and prepares the law for `points` points and `lanes` lanes. A law that changes the problem gets those of a
  /// beam with stops at so many nodes, ten at most. Throws Refused.
  LawBench(const Law& law, int points, int lanes);
  ContactLaw& law() { return *law_; }
  const ContactLaw& law() const { return *law_; }
  /// How far before a stop the law acts.
  double layer() const { return law_->layer(0); }

  /// Whether what the law keeps lasts from one solve to the next (not at first); it begins with none.
  void remember(bool on);
  /// What the law keeps, and the same put in its place, to last; of it, what belongs to a lane, or to one of its
  /// points.
  std::vector<double> memory() const { return {memory_.begin(), memory_.end()}; }
  void keep(const std::vector<double>& memory);
  std::vector<double> of_lane(const std::vector<double>& memory, int lane) const;
  std::vector<double> of_point(const std::vector<double>& memory, Eigen::Index point, int lane) const;
  /// How the law left that side of the first point of the first lane, and its depth; `side` as in at_point().
  StopState state(int side, double depth) const;
  /// Asks the law: `touched` lanes of `problems` (one per lane). The law's memory is forgotten before, unless it lasts.
  void solve(DenseDelassus& W, double reach, double rate_reach, const std::vector<LaneProblem>& problems,
             const std::vector<int>& touched);
  Eigen::VectorXd effort(int lane) const;
  const LaneOutcome& outcome(int lane) const { return outcomes_[lane]; }
  long allocations() const { return allocations_; }  ///< of the last solve

 private:
  std::size_t numbers() const { return static_cast<std::size_t>(points_ * lanes_); }

  std::unique_ptr<ContactLaw> law_;
  int points_, lanes_;
  GuardedArray<double> free_, lower_, upper_, rate_, before_, effort_, memory_;
  GuardedArray<LaneOutcome> outcomes_;
  long allocations_ = 0;
  bool remembers_ = false;
};

/// The answer of the law at one point whose measure no effort moves. It is p at depth δ beyond the lower (side −1) or
/// upper (+1) stop. The point has the speed u and, one step before, the depth δ⁻. Not `answered`: the law has no force
/// there, as a barrier beyond its stop.
struct PointAnswer {
  double effort = 0, dissipation = 0;
  bool answered = true;
  ContactSlopes slopes;
};
PointAnswer at_point(LawBench& bench, int side, double depth, double speed, double before);
/// Depths at which a law that acts from its layer on can be asked, in order; a barrier never lets a point reach 0.
std::vector<double> depths_of(LawBench& bench);
/// Whether the law acts before its stop and has no force beyond it.
bool is_barrier(LawBench& bench);

/// A lane with a random measure between random stops, m points of size 1e-2 m. `two_sided`: both stops, so near that
/// points touch both; else the lower one alone.
LaneProblem random_lane(std::mt19937& random, int points, bool two_sided);
/// W = A Aᵀ/m + a little, of size `flexibility` m/N.
DenseDelassus random_delassus(std::mt19937& random, int points, double flexibility);

/// m/N at which the law is asked: the inverse of its stiffness, found from what one point answers; 1e-4 where rigid.
double flexibility_of(const Law& law);

/// Lanes of a block that are solved together.
constexpr int lanes_of_block = 4;
/// The layer of a law that is a barrier, else 0; the reach at which a law is asked: no effort moves a barrier's point.
double barrier_of(const Law& law);
double reach_of(const Law& law);
/// A block of random lanes; those of a barrier lie within its layer.
std::vector<LaneProblem> random_lanes(std::mt19937& random, int points, double barrier);

inline constexpr const char* no_contact_at_all = "the law is the absence of contact";

// Rigid laws.
Verdict complementarity_holds(const Law& law);

// Compliant laws (law_compliant.cpp).
Verdict force_law_is_one(const Law& law);
Verdict solution_answers_the_force_law(const Law& law);
Verdict stiffness_as_declared(const Law& law);
Verdict slopes_are_derivatives(const Law& law);
Verdict potential_stores_the_force(const Law& law);
Verdict energy_over_a_step(const Law& law);
Verdict dissipation_is_reported(const Law& law);

// What lasts from one solve to the next (law_memory.cpp).
Verdict answers_follow_from_memory(const Law& law);
/// A law that remembers, pressed, let go and pressed again, deeper. It stores no more than was put in, and nothing that
/// no force gives back. What it reports as dissipated is a damper's at least, and no more than is lost.
Verdict stores_what_it_gives_back(const Law& law);
Verdict dissipates_what_is_lost(const Law& law);

// Laws that change the problem.
Verdict changed_problem_is_sound(const Law& law);

// All laws.
Verdict solve_stays_within(const Law& law);
Verdict solve_allocates_nothing(const Law& law);
Verdict warm_start_changes_nothing(const Law& law);

// Lanes and points with parameters of their own (law_lanes.cpp).
Verdict lanes_are_independent(const Law& law);
Verdict unlike_lanes_are_their_own(const Law& law);
Verdict untouched_lanes_are_left_alone(const Law& law);
Verdict points_have_own_sets(const Law& law);

const std::vector<Check<ContactLaw>>& law_checks();

}  // namespace ricochet::checking
