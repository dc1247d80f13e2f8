#pragma once
#include <ricochet/contract/reference.hpp>

#include "beam_run.hpp"

/// \file
/// The phases of the beam as a map of x = (a, b), modal displacements and velocities of flight.
namespace ricochet::event_driven {

class BeamMap final : public ReferenceMap {
 public:
  BeamMap(const ReferenceProblem& problem, const Settings& settings)
      : problem_(problem), modes_(settings.modes), run_(problem_, grid_, settings) {
    problem_.discrete = nullptr;
  }

  int size() const override { return 2 * modes_; }
  Eigen::VectorXd start() const override {
    Eigen::ArrayXd a, b;
    run_.project_start(a, b);
    return joined(a, b);
  }
  Eigen::VectorXd weights() const override {
    const Beam& beam = run_.beam();
    const double weight = 1 / std::sqrt(beam.length);
    const double omega = beam.support.pulsation > 0 ? beam.support.pulsation : 1;
    Eigen::VectorXd all = Eigen::VectorXd::Constant(size(), weight);
    all.tail(modes_) /= omega;
    return all;
  }
  std::pair<double, double> tip(const Eigen::VectorXd& x) const override {
    const Beam& beam = run_.beam();
    const Eigen::VectorXd shape = beam.free.end_value.matrix();
    return {shape.dot(x.head(modes_)) + beam.support.at(0), shape.dot(x.tail(modes_)) + beam.support.rate(0)};
  }
  Image march(const Eigen::VectorXd& x, double span, bool derivative) override {
    Image image;
    if (derivative) image.derivative = Eigen::MatrixXd::Identity(size(), size());
    grid_.times = {span};
    Eigen::ArrayXd a = x.head(modes_).array(), b = x.tail(modes_).array();
    const auto motion = run_.motion_from(a, b, derivative ? &image.derivative : nullptr);
    if (const auto* refusal = std::get_if<Refusal>(&motion)) {
      image.stopped = refusal->sentence;
      return image;
    }
    for (const ContactEvent& event : std::get<SampledMotion>(motion).events) image.impacts += event.begins;
    image.state = joined(a, b);
    return image;
  }

 private:
  static Eigen::VectorXd joined(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
    Eigen::VectorXd x(a.size() + b.size());
    x << a.matrix(), b.matrix();
    return x;
  }

  ReferenceProblem problem_;
  SampleGrid grid_;
  int modes_;
  BeamRun run_;
};

}  // namespace ricochet::event_driven
