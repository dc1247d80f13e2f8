#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/branches.hpp>
#include <set>

#include "runners/execution/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {
namespace {

constexpr double kHalf = 0.5, kNothing = 1e-12;

/// The sections at one value, case by case, start by start.
using Sections = std::map<std::pair<std::size_t, int>, SettledSection>;

/// Whether there is anything to compare: a march that was stopped leaves no section.
bool settled(const Run& run) {
  return run.status == "done";
}

Sections sections_at(const Diagram& diagram, int value) {
  Sections out;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c)
    for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s)
      if (const Run* run = diagram.run(c, value, s); run && settled(*run))
        out.emplace(std::pair(c, s), settled_section(diagram, diagram.cases[c], *run));
  return out;
}

/// One attractor of one case, with the starts that lead to it.
struct OwnAttractor {
  std::size_t owner = 0;
  std::vector<int> starts;
  SettledSection section;
};

/// A motion without contact is the linear response: of one scene there is one, told by its kind.
SettledSection for_matching(const SettledSection& section, bool linear) {
  if (!linear) return section;
  return {section.kind, true, {}};
}

std::vector<OwnAttractor> own_attractors(const Diagram& diagram, const Sections& sections, int value) {
  std::vector<OwnAttractor> out;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    std::vector<int> starts;
    std::vector<SettledSection> decided;
    for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s) {
      const Run* run = diagram.run(c, value, s);
      if (!run || !run->decided()) continue;
      starts.push_back(s);
      decided.push_back(for_matching(sections.at({c, s}), run->regime == "no contact"));
    }
    const std::vector<int> labels = cluster_starts(decided);
    const std::size_t first = out.size();
    for (std::size_t k = 0; k < labels.size(); ++k) {
      const std::size_t place = first + static_cast<std::size_t>(labels[k]);
      if (place == out.size()) out.push_back({c, {}, std::move(decided[k])});
      out[place].starts.push_back(starts[k]);
    }
  }
  return out;
}

void add_distances(const Diagram& diagram, const Sections& sections, int value, std::size_t reference,
                   DerivedTable& table) {
  const CaseRuns& standard = diagram.cases[reference];
  for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s) {
    const Run* one = diagram.run(reference, value, s);
    if (!one) continue;
    const auto of_reference = sections.find({reference, s});
    HalvesNull null;
    if (of_reference != sections.end()) null = null_of(diagram, standard, *one);
    for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
      const Run* other = diagram.run(c, value, s);
      if (c == reference || !other) continue;
      Row row = axes_row(*diagram.results, *diagram.cases[c].record);
      row.insert(row.end(), {standard.record->id, one->parameter, diagram.starts[static_cast<std::size_t>(s)]});
      const auto of_other = sections.find({c, s});
      const Json same = one->decided() && other->decided() ? Json(one->kind == other->kind) : Json(nullptr);
      if (of_reference == sections.end() || of_other == sections.end() || of_reference->second.cloud.empty() ||
          of_other->second.cloud.empty()) {
        row.insert(row.end(), {nullptr, nullptr, nullptr, nullptr, nullptr, same, ""});
      } else {
        const SectionCloud &a = of_reference->second.cloud, &b = of_other->second.cloud;
        const double distance = cloud_distance(a, b);
        const bool noisy = null.wasserstein > kNothing;
        row.insert(row.end(), {distance, cloud_hausdorff(a, b), null.wasserstein, null.hausdorff,
                               noisy ? number_cell(distance / null.wasserstein) : Json(nullptr), same,
                               compared_exactly(a, b) ? "exact" : "sliced"});
      }
      table.rows.push_back(std::move(row));
    }
  }
}

/// Runs of one attractor, and all decided runs beside them.
struct Extent {
  int kind = -1, first = -1, last = -1;
  std::set<std::size_t> cases;
  std::set<int> values;
  int symmetric = 0, asymmetric = 0, unknown = 0;
};

std::vector<Extent> extents_of(const Diagram& diagram) {
  std::vector<Extent> out(static_cast<std::size_t>(diagram.attractors));
  for (std::size_t c = 0; c < diagram.cases.size(); ++c)
    for (const Run& run : diagram.cases[c].runs) {
      if (run.attractor == 0) continue;
      Extent& extent = out[static_cast<std::size_t>(run.attractor) - 1];
      extent.kind = run.kind;
      extent.first = extent.first < 0 ? run.value : std::min(extent.first, run.value);
      extent.last = std::max(extent.last, run.value);
      extent.cases.insert(c);
      extent.values.insert(run.value);
      ++(!run.symmetric ? extent.unknown : *run.symmetric ? extent.symmetric : extent.asymmetric);
    }
  return out;
}

bool shows(const Diagram& diagram, std::size_t c, int value, int attractor) {
  for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s)
    if (const Run* run = diagram.run(c, value, s); run && run->attractor == attractor) return true;
  return false;
}

bool decides(const Diagram& diagram, std::size_t c, int value) {
  for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s)
    if (const Run* run = diagram.run(c, value, s); run && run->decided()) return true;
  return false;
}

Presence presence_of(const Diagram& diagram, const Extent& extent, int attractor) {
  Presence out;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    int told = 0, shown = 0;
    for (const int value : extent.values)
      if (decides(diagram, c, value)) {
        ++told;
        shown += shows(diagram, c, value, attractor);
      }
    if (told == 0) continue;
    out.cases.push_back(c);
    out.present.push_back(shown >= kHalf * told);
  }
  return out;
}

/// Share of the starts that lead there, where a case shows it at all. A start counts once in the interval, however many
/// values and cases repeat it: those are no independent trials.
Proportion fraction_of(const Diagram& diagram, const Extent& extent, int attractor) {
  std::vector<int> drawn, all;
  for (int s = 0; s < static_cast<int>(diagram.starts.size()); ++s) {
    all.push_back(s);
    if (diagram.starts[static_cast<std::size_t>(s)].starts_with("random-")) drawn.push_back(s);
  }
  const std::vector<int>& starts = drawn.size() >= 2 ? drawn : all;
  double reached = 0, tried = 0;
  std::set<int> used;
  for (const std::size_t c : extent.cases)
    for (const int value : extent.values) {
      if (!shows(diagram, c, value, attractor)) continue;
      for (const int s : starts)
        if (const Run* run = diagram.run(c, value, s); run && run->decided()) {
          ++tried;
          reached += run->attractor == attractor;
          used.insert(s);
        }
    }
  return wilson_interval(tried > 0 ? reached / tried : 0, static_cast<double>(used.size()));
}

Json symmetric_cell(const Extent& extent) {
  if (extent.symmetric > 0 && extent.asymmetric == 0) return true;
  if (extent.asymmetric > 0 && extent.symmetric == 0) return false;
  return nullptr;
}

}  // namespace

DerivedTable find_attractors(Diagram& diagram) {
  DerivedTable distances = table_with_axes(*diagram.results, "distances",
                                           {"reference_case", "parameter", "start", "wasserstein", "hausdorff",
                                            "null_wasserstein", "null_hausdorff", "ratio", "same_class", "formula"});
  const auto reference = reference_case(diagram);
  Branches branches;
  for (int value = 0; value < static_cast<int>(diagram.values.size()); ++value) {
    const Sections sections = sections_at(diagram, value);
    if (reference) add_distances(diagram, sections, value, *reference, distances);
    std::vector<OwnAttractor> own = own_attractors(diagram, sections, value);
    std::vector<OwnedSection> members;
    for (const OwnAttractor& one : own) members.push_back({static_cast<int>(one.owner), &one.section});
    const std::vector<int> labels = match_owners(members);
    std::vector<AttractorGroup> groups;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const auto place = static_cast<std::size_t>(labels[k]);
      if (place == groups.size()) groups.push_back({own[k].section.kind, {}});
      groups[place].sections[members[k].owner] = std::move(own[k].section);
    }
    const std::vector<int> identities = branches.add(groups);
    for (std::size_t k = 0; k < own.size(); ++k)
      for (const int s : own[k].starts) {
        CaseRuns& owner = diagram.cases[own[k].owner];
        const int run = owner.at[static_cast<std::size_t>(value) * diagram.starts.size() + static_cast<std::size_t>(s)];
        owner.runs[static_cast<std::size_t>(run)].attractor = identities[static_cast<std::size_t>(labels[k])] + 1;
      }
  }
  diagram.attractors = branches.count();
  return distances;
}

DerivedTable attractors_table(const Diagram& diagram) {
  DerivedTable table{"attractors",
                     {"attractor", "label", "cases", "from", "to", "class", "period", "symmetric", "fraction",
                      "fraction_low", "fraction_high", "presence", "sentence"},
                     {}};
  const std::vector<Extent> extents = extents_of(diagram);
  for (std::size_t k = 0; k < extents.size(); ++k) {
    const Extent& extent = extents[k];
    if (extent.kind < 0) continue;
    const int attractor = static_cast<int>(k) + 1;
    const std::string& kind = diagram.kind_name(extent.kind);
    const bool periodic = kind.starts_with("periodic ");
    const double from = diagram.values[static_cast<std::size_t>(extent.first)],
                 to = diagram.values[static_cast<std::size_t>(extent.last)];
    const PresenceLabel label = label_presence(presence_of(diagram, extent, attractor), diagram.axes);
    const Proportion fraction = fraction_of(diagram, extent, attractor);
    const std::string range = extent.first == extent.last
                                  ? "at " + short_number(from)
                                  : fmt::format("{} to {}, {}", short_number(from), short_number(to),
                                                count_of(extent.values.size(), "value"));
    table.rows.push_back({attractor, label.label, extent.cases.size(), from, to, periodic ? "periodic" : kind,
                          periodic ? Json(std::stoi(kind.substr(9))) : Json(nullptr), symmetric_cell(extent),
                          fraction.value, fraction.low, fraction.high, label.presence,
                          fmt::format("Attractor {} ({}, {}) {}", attractor, kind, range, label.sentence)});
  }
  return table;
}

}  // namespace ricochet::dynamics
