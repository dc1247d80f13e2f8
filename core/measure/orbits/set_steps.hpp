#pragma once
#include <Eigen/Core>
#include <compare>
#include <deque>
#include <map>
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <string>
#include <vector>

/// \file
/// Steps of a program as affine maps, one for each contact set. Of a position-level plan with a law that is rigid or a
/// linear spring a step is, as long as the same points are closed,
///
///     X ← A X + B r,     v = Y X + Z r
///
/// X holds the slots, then p₋₁, p₋₂, … as far as the plan weights them. The vector r is what drives the step. Per point
/// of each stage that reads contact, v is the effort (N) of a closed point or the measure (m) of an open one.
namespace ricochet {

/// How many efforts of steps before a step of this program weights: p₋₁, p₋₂, …
int past_efforts(const Program& program);

/// A point that is closed in a stage of a step, and by which of its stops.
struct SetPoint {
  int stage = 0, point = 0;
  bool upper = false;
  auto operator<=>(const SetPoint&) const = default;
};
/// The closed points of one step, ascending.
using ContactSet = std::vector<SetPoint>;

/// What drives a step. A sin(ωt + ψ) and A cos(ωt + ψ) of the support come first. The lower bounds of all points
/// follow, then the upper ones (0 where there is none). Σ φ_k F(t + c_k h) of each stage is last, where there is a
/// load.
struct DriveLayout {
  int points = 0, loads = 0;
  int lower(int point) const { return 2 + point; }
  int upper(int point) const { return 2 + points + point; }
  int load() const { return 2 + 2 * points; }
  int size() const { return load() + loads; }
};

/// One contact set: rows of X after the step, then of v, over X and over r.
struct SetStep {
  ContactSet closed;
  Eigen::MatrixXd state;  ///< (D + rows) × D
  Eigen::MatrixXd drive;  ///< (D + rows) × r
  /// Per closed row what one newton moves the measure by, the point alone being free to move, m/N. The free measure is
  /// beyond the bound by that times the effort.
  std::vector<double> give;
  std::vector<int> side;  ///< per row: 0 open, −1 closed by the lower stop, 1 by the upper one
};

/// Steps with one contact set, 2^k of them at once, loads apart:
///
///     X ← A^{2^k} X + B_k r,     v_j = Y A^j X + Z_j r,  j = 0 … 2^k − 1
///
/// r is that of the first of them: sine and cosine turn by ωh a step.
struct SetStrides {
  std::vector<Eigen::MatrixXd> state;  ///< A, A², A⁴, …: D × D
  std::vector<Eigen::MatrixXd> drive;  ///< B_0, B_1, …: D × (2 + 2 points)
  Eigen::MatrixXd measured;            ///< Y A^j, one below the other
  Eigen::MatrixXd measured_drive;      ///< Z_j
};

/// The steps of a program by contact set, made when first asked for. They are told apart by numbers; 0 is the open set.
class SetSteps {
 public:
  /// Why a step is not affine between changes of contact; nothing where it is.
  static std::optional<std::string> refusal(const Program& program);

  /// Of a program for which refusal() has nothing to say.
  explicit SetSteps(const Program& program);

  int state_size() const { return size_; }
  int slots_size() const { return rows_ * slots_; }
  int past_efforts() const { return past_; }
  /// Rows of v: points of the first stage that reads contact, then of the next.
  int measure_rows() const { return static_cast<int>(reading_.size()) * layout_.points; }
  int points() const { return layout_.points; }
  /// The stage of a row, and its point.
  SetPoint place(int row) const {
    return {reading_[static_cast<std::size_t>(row / layout_.points)], row % layout_.points, false};
  }
  int row_of(const SetPoint& at) const;
  const DriveLayout& layout() const { return layout_; }

  int number(const ContactSet& set);
  const SetStep& operator[](int number) const { return steps_[static_cast<std::size_t>(number)]; }
  int count() const { return static_cast<int>(steps_.size()); }
  /// The set with a row opened, or closed by one of its stops.
  int toggled(int number, int row, bool upper);
  /// Whether a set is another one with lower and upper stops exchanged.
  bool mirrors(int one, int other) const;
  /// A^{2^k} of a set.
  const Eigen::MatrixXd& power(int number, std::size_t k);
  /// Those of a set, up to 2^k steps and measured rows at least.
  const SetStrides& strides(int number, std::size_t k);
  /// The largest k for which 2^k steps at once cost less than they do in two halves, measured rows included; at most 6.
  std::size_t longest_stride() const;
  /// M ← A^count M; M ← (A^count)ᵀ M.
  void apply(int number, long long count, Eigen::MatrixXd& columns);
  void apply_transposed(int number, long long count, Eigen::MatrixXd& columns);

 private:
  struct Stage {
    Eigen::MatrixXd history;     // n × slots n: what of the slots drives S z
    Eigen::MatrixXd response;    // S⁻¹Hᵀ
    Eigen::MatrixXd delassus;    // H S⁻¹ Hᵀ
    Eigen::MatrixXd free_drive;  // S⁻¹ of what drives
    DenseLu system;
    bool solves = false, reads = false;
    double stiffness = 0;  // κ; 0: rigid
  };
  SetStep make(const ContactSet& set) const;
  Eigen::MatrixXd closing_efforts(std::size_t k, const std::vector<Eigen::Index>& closed,
                                  const Eigen::MatrixXd& measured, Eigen::Index first, SetStep& step) const;
  Eigen::MatrixXd combine(const Combination& c, const Eigen::MatrixXd& now, const Eigen::MatrixXd& z) const;
  Eigen::MatrixXd turned(Eigen::MatrixXd drive, long long steps) const;

  const Program* program_;
  int rows_ = 0, slots_ = 0, size_ = 0, past_ = 0;
  DriveLayout layout_;
  std::vector<int> reading_;  // stages that read contact
  Eigen::MatrixXd contact_;   // H
  std::vector<Stage> stages_;
  std::deque<SetStep> steps_;  // which stay where they are
  std::deque<SetStrides> strides_;
  std::map<ContactSet, int> numbers_;
};

}  // namespace ricochet
