#include "runners/kinds/basins/cell_ends.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr double cycle_tolerance = 1e-3;
// Beyond the null of 19 draws, which one run in 20 exceeds; and never asked to be closer than a twentieth of the room.
constexpr LinkRule cell_rule{0.05, 1.5};
constexpr std::uint64_t mark = 0x3173646e65'0001;  // what the bytes are, and their version

template <class Archive, class End>
void describe(Archive& archive, End& end) {
  archive(end.regime);
  archive(end.period);
  archive(end.periods);
  archive(end.status);
  archive(end.reason);
  archive(end.section);
  archive(end.displacements);
}

}  // namespace

CellEnd cell_end(const Orbit& orbit, const SectionPlan& plan) {
  OrbitView view;
  view.orbit = &orbit;
  judge(view, plan);
  CellEnd end;
  std::tie(end.status, end.reason) = status_of(view);
  end.periods = orbit.transient_periods + orbit.kept_periods;
  if (orbit.stage != Orbit::Stage::complete) return end;
  end.regime = view.verdict.regime;
  end.period = view.verdict.period;
  const std::size_t wanted = static_cast<std::size_t>(end.period > 0 ? end.period : longest_cell_section);
  const std::size_t first = orbit.strobed.size() - std::min(orbit.strobed.size(), wanted);
  const auto width = static_cast<std::size_t>(orbit.readings.width);
  for (std::size_t i = first; i < orbit.strobed.size(); ++i) {
    end.section.push_back(orbit.strobed[i]);
    end.displacements.push_back(orbit.readings.values[i * width]);
  }
  return end;
}

CellEnd refused_end(const std::string& sentence) {
  CellEnd end;
  end.status = "refused";
  end.reason = sentence;
  return end;
}

std::string to_bytes(const std::vector<CellEnd>& ends) {
  ByteWriter writer;
  writer(mark);
  writer(static_cast<std::uint64_t>(ends.size()));
  for (const CellEnd& end : ends) describe(writer, end);
  return std::move(writer.bytes);
}

std::vector<CellEnd> cell_ends(const std::string& bytes) {
  ByteReader reader(bytes);
  std::uint64_t found = 0;
  reader(found);
  if (found != mark) throw std::runtime_error("stored cells are of another version");
  std::vector<CellEnd> ends(reader.count(sizeof(std::uint64_t)));
  for (CellEnd& end : ends) describe(reader, end);
  return ends;
}

SettledSection EndLabels::settled(const CellEnd& end) const {
  SettledSection out;
  out.kind = static_cast<int>(end.regime);
  std::vector<CloudPoint> run;
  for (std::size_t i = 0; i < end.section.size(); ++i) run.push_back({end.displacements[i], end.section[i].velocity});
  out.cloud = make_cloud(run, {}, {plan_.scale, plan_.scale * plan_.pulsation}, 0);
  return out;
}

bool EndLabels::same_cycle(const CellEnd& a, const CellEnd& b) const {
  const std::size_t period = a.section.size();
  if (a.period != b.period || b.section.size() != period) return false;
  const double speed = plan_.scale * plan_.pulsation;
  for (std::size_t shift = 0; shift < period; ++shift) {
    bool all = true;
    for (std::size_t i = 0; i < period && all; ++i) {
      const std::size_t j = (i + shift) % period;
      all = std::abs(a.displacements[i] - b.displacements[j]) <= cycle_tolerance * plan_.scale &&
            std::abs(a.section[i].velocity - b.section[j].velocity) <= cycle_tolerance * speed;
    }
    if (all) return true;
  }
  return false;
}

int EndLabels::label(const CellEnd& end) {
  Known one{end, {}};
  const bool wandering = end.regime == Regime::quasi_periodic || end.regime == Regime::chaotic;
  if (wandering) one.section = settled(end);
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const Known& other = known_[i];
    if (other.end.regime != end.regime || other.end.status != end.status) continue;
    if (end.regime == Regime::periodic && !same_cycle(end, other.end)) continue;
    if (wandering && relative_distance(one.section, other.section, cell_rule) > 1) continue;
    return static_cast<int>(i);
  }
  known_.push_back(std::move(one));
  return static_cast<int>(known_.size()) - 1;
}

}  // namespace ricochet
