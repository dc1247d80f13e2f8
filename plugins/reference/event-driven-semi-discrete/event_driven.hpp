#pragma once
#include <map>
#include <string>
#include <vector>

#include "contact_points.hpp"
#include "motion_record.hpp"
#include "phase_march.hpp"

namespace ricochet::reference {

/// Follows the motion from event to event: which points are closed, and what happens where that changes. Throws Stopped
/// where it cannot.
class EventDriven {
 public:
  /// `resolution`: step of the search for events × fastest rate.
  EventDriven(const ReferenceProblem& problem, const SampleGrid& grid, double resolution);
  EventDriven(const EventDriven&) = delete;

  SampledMotion run();
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  bool rigid() const { return at_.spring == 0; }
  const ContactModes& modes(const ContactSet& set);

  // The set at t = 0.
  void enter(State& now);
  void close_at_start(State& now);
  double gap(const State& now, Eigen::Index i, int sign, double& round_off) const;
  void hold(const State& start);
  void let_go(const State& seen);
  ContactSet touched(const State& now) const;
  ContactSet pushed_set(const State& now, const ContactSet& touching);
  void note_jump(const State& given, const State& released);

  // Transitions.
  void change(const State& now, const ContactSet& next, bool struck = false);
  void turn(State& now, const Watch& watch);
  void strike(State& now, const Watch& watch);
  void begin(const State& now, int point = -1);

  const ReferenceProblem& problem_;
  LinearStructure at_;
  MotionRecord record_;
  ContactModes open_;
  ContactPoints points_;
  PhaseMarch march_;
  std::map<ContactSet, ContactModes> known_;

  ContactSet set_;
  ContactSet held_;  // by the stop that they start on
  std::vector<std::string> notes_;
  double impulse_ = 0, travel_ = 0, struck_speed_ = 0;
  Eigen::Index stuck_ = 0;
};

}  // namespace ricochet::reference
