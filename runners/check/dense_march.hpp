#pragma once
#include <Eigen/Core>
#include <ricochet/engine/marcher.hpp>
#include <string>
#include <vector>

namespace ricochet::checking {

/// The plan of a marcher evaluated anew beside it, with dense matrices and nothing of the engine but the efforts that
/// its law found: S, b, weighted efforts, updates; then whether those efforts answer the measures found here.
class DenseMarch final : public StepObserver {
 public:
  explicit DenseMarch(const Marcher& marcher);
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  /// What differs by more than round-off, or "".
  const std::string& difference() const { return difference_; }

 private:
  struct Lane {
    LaneSpec spec;
    std::vector<Eigen::VectorXd> slots;
    std::vector<Eigen::VectorXd> past;  // p₋₁, p₋₂, …
    Eigen::VectorXd last_start;         // of the start rule's last stage
    bool starting = true;
    double fastest = 0;
    std::vector<Eigen::VectorXd> efforts, ways;  // of each stage of the step: p, and H s + Δφ of its work form
  };
  /// What a stage has found.
  struct Found {
    Eigen::VectorXd z, w, p;
    Eigen::VectorXd free;  ///< z without p
  };
  Eigen::VectorXd combined(const Lane& lane, const Combination& c, const Found& found) const;
  double support(const Lane& lane, double t, const Levels& levels, bool rate) const;
  Eigen::VectorXd load(const Lane& lane, double t, const Levels& levels) const;
  void look_at_contact(const Stage& stage, const Lane& lane, const Found& found, double t);
  void look_at_work(const Lane& lane, std::size_t k, std::size_t source);
  void look_at_gate(const ImpactMeasure& impact, const Lane& lane, const Eigen::VectorXd& y, const Found& found,
                    double t);
  void note(const std::string& sentence);

  const SemiDiscrete& problem_;
  StepPlan plan_;
  double h_;
  std::optional<Evaluation> reads_;
  bool absent_;
  Eigen::MatrixXd M_, C_, K_, H_;
  std::vector<Lane> lanes_;
  std::string difference_;
  long long step_ = 0;
};

}  // namespace ricochet::checking
