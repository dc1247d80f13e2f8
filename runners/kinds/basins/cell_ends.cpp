#include "runners/kinds/basins/cell_ends.hpp"

#include <algorithm>
#include <tuple>

#include "runners/march/bytes.hpp"

namespace ricochet {
namespace {

constexpr std::uint64_t mark = 0x3173646e65'0002;  // what the bytes are, and their version

template <class Archive, class End>
void describe(Archive& archive, End& end) {
  archive(end.motion.regime);
  archive(end.motion.period);
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
  const RegimeVerdict& verdict = view.judged.verdict;
  CellEnd end;
  std::tie(end.status, end.reason) = status_of(view);
  end.periods = orbit.transient_periods + orbit.kept_periods;
  if (orbit.stage != Orbit::Stage::complete) return end;
  end.motion = verdict.motion;
  end.period = verdict.period;
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

SettledSection settled_section(const CellEnd& end, const SectionPlan& plan) {
  // A motion without contact is the linear response, told by its class.
  if (end.motion.regime == Regime::no_contact) return {end.motion, true, {}};
  std::vector<CloudPoint> run, opposite;
  for (std::size_t i = 0; i < end.section.size(); ++i) {
    run.push_back({end.displacements[i], end.section[i].velocity});
    opposite.push_back({end.section[i].opposite_displacement, end.section[i].opposite_velocity});
  }
  const int cycle = end.motion.period;
  return {end.motion, cycle > 0, make_cloud(run, opposite, {plan.scale, plan.scale * plan.pulsation}, cycle)};
}

}  // namespace ricochet
