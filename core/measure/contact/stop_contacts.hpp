#pragma once
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/stop_places.hpp>
#include <vector>

namespace ricochet {

/// Contact stop by stop, from what an ImpactRecorder tells of contact points in lane 0. Without clearances it is that
/// recorder. A circle is one point of it. The sides of a polygon are one stop, pushed at an instant by their resultant,
///
///     I = |Σ I_k d_k|   (N s),     F = I/Ω   (N),     d_k the direction in which side k is met,
///
/// and in contact as long as one of them is: to pass from side to side is no impact. All is told of its upper side. Its
/// speed in is that along the resultant, Σ I_k v_k / I, of all that closes. Its speed out is the same over the sides
/// that it leaves.
class StopContacts final : public ContactListener {
 public:
  /// Is told by `recorder` from now on. Both outlive the integration.
  StopContacts(const Marcher& marcher, ImpactRecorder& recorder);
  StopContacts(const StopContacts&) = delete;
  StopContacts& operator=(const StopContacts&) = delete;

  const StopList& list() const { return list_; }
  /// Tells `listener` of every instant from now on; points are numbers of stops then.
  void tell(ContactListener* listener);

  void instant(const ContactInstant& one) override;
  void over(double time) override;
  /// To be called once, after that of the recorder.
  void finish();

  /// In the order in which they began; `point` is the number of a stop.
  const std::vector<Impact>& impacts() const { return merges() ? impacts_ : recorder_.impacts(0); }
  long long count() const { return merges() ? count_ : recorder_.count(0); }
  StopTotals totals(int stop, StopSide side) const;
  /// Whether there is any clearance.
  bool merges() const { return list_.count() < static_cast<int>(list_.stop_of.size()); }
  /// Σ I over all stops, N s; of merged ones.
  double impulse() const { return impulse_; }
  /// Σ of the forces of the last instant, positive upwards; of a clearance along its first component, N. Of merged
  /// ones.
  double upwards() const { return upwards_; }
  /// As the recorder has them.
  double force() const { return merges() ? force_ : recorder_.force(0); }
  double take_peak();

 private:
  static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  struct Share {
    std::size_t impact = nowhere;  // of the recorder
    double weight = 0;
  };
  struct Round {
    int stop = 0, first = 0;
    std::vector<std::array<double, 2>> normals;  // of each row
    // Of the instant under way.
    bool pushed = false, closes = true;
    double given[2] = {0, 0}, direction[2] = {0, 0}, lasts = 0, came = 0;
    std::vector<Share> shares;
    // Since it closed.
    bool closed = false;
    std::size_t row = nowhere;
    double speed_in = 0;
    std::vector<Share> leaves;  // at the last instant
    StopTotals totals;
  };
  void add(const ContactInstant& told, double upwards);
  void end_instant(Round& round, double time);
  void begin_impact(Round& round, double time);

  ImpactRecorder& recorder_;
  StopList list_;
  std::vector<Round> rounds_;  // of polygons
  std::vector<int> round_of_;  // of each stop; −1: its one point tells all
  std::vector<ContactListener*> listeners_;
  std::vector<Impact> impacts_;
  std::vector<std::vector<Share>> leaves_;  // of each impact; one of weight 1 where the recorder's is it
  std::vector<std::size_t> own_;            // of stops that are no clearance, the row of the impact under way
  long long count_ = 0;
  double force_ = 0, pressed_ = 0, peak_ = 0, upwards_ = 0, pushed_upwards_ = 0, impulse_ = 0;
};

}  // namespace ricochet
