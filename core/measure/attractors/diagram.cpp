#include <algorithm>
#include <cmath>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/diagram.hpp>
#include <set>
#include <tuple>
#include <utility>

namespace ricochet {

int DiagramRun::cycle() const {
  return cycle_of(motion, period);
}

bool DiagramCase::any_decided() const {
  return std::any_of(runs.begin(), runs.end(), [](const DiagramRun& run) { return run.decided(); });
}

const DiagramRun* Diagram::run(std::size_t case_index, int value, int start) const {
  const DiagramCase& owner = cases[case_index];
  const int k = owner.at[static_cast<std::size_t>(value) * starts.size() + static_cast<std::size_t>(start)];
  return k < 0 ? nullptr : &owner.runs[static_cast<std::size_t>(k)];
}

DiagramRun* Diagram::run(std::size_t case_index, int value, int start) {
  return const_cast<DiagramRun*>(std::as_const(*this).run(case_index, value, start));
}

void Diagram::number_values() {
  std::set<double> all;
  for (const DiagramCase& owner : cases)
    for (const DiagramRun& run : owner.runs) all.insert(run.parameter);
  values.assign(all.begin(), all.end());
  for (DiagramCase& owner : cases) {
    owner.at.assign(values.size() * starts.size(), -1);
    for (std::size_t k = 0; k < owner.runs.size(); ++k) {
      DiagramRun& run = owner.runs[k];
      run.value = static_cast<int>(std::lower_bound(values.begin(), values.end(), run.parameter) - values.begin());
      owner.at[static_cast<std::size_t>(run.value) * starts.size() + static_cast<std::size_t>(run.start)] =
          static_cast<int>(k);
    }
  }
}

std::optional<std::size_t> reference_case(const Diagram& diagram) {
  std::optional<std::size_t> best;
  std::tuple<double, double, double, double> best_rank;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    const DiagramCase& one = diagram.cases[c];
    if (!one.any_decided()) continue;
    const std::tuple rank(-one.compliance.value_or(INFINITY), one.steps_per_period, one.elements, one.modes);
    if (!best || rank > best_rank) {
      best = c;
      best_rank = rank;
    }
  }
  return best;
}

Agreement agreement(const DiagramCase& one, const DiagramCase& other) {
  Agreement out;
  for (std::size_t k = 0; k < one.at.size(); ++k) {
    if (one.at[k] < 0 || other.at[k] < 0) continue;
    const DiagramRun &a = one.runs[static_cast<std::size_t>(one.at[k])],
                     &b = other.runs[static_cast<std::size_t>(other.at[k])];
    if (!a.decided() || !b.decided()) continue;
    ++out.compared;
    out.same_class += a.motion == b.motion;
    out.same_attractor += a.attractor == b.attractor;
  }
  return out;
}

namespace {

constexpr double kHalf = 0.5;

/// One attractor of one case, with the starts that lead to it.
struct OwnAttractor {
  std::size_t owner = 0;
  std::vector<int> starts;
  SettledSection section;
};

/// A motion without contact is the linear response: of one scene there is one, told by its class.
SettledSection for_matching(const SettledSection& section, bool linear) {
  if (!linear) return section;
  return {section.motion, {}};
}

std::vector<OwnAttractor> own_attractors(const Diagram& diagram, const ValueSections& sections, int value) {
  std::vector<OwnAttractor> out;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    std::vector<int> starts;
    std::vector<SettledSection> decided;
    for (int s = 0; s < diagram.start_count(); ++s) {
      const DiagramRun* run = diagram.run(c, value, s);
      if (!run || !run->decided()) continue;
      starts.push_back(s);
      decided.push_back(for_matching(sections.at({c, s}), run->motion.regime == Regime::no_contact));
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

/// Branches of every case while the values go by, and how near those of different cases are to each other.
class Following {
 public:
  explicit Following(std::size_t cases) : along_(cases), first_(cases) {}

  /// The attractors of all cases at one value; the runs keep the branch until finish().
  void add(Diagram& diagram, const std::vector<OwnAttractor>& own, int value) {
    std::vector<int> branch(own.size(), -1);
    for (std::size_t first = 0; first < own.size();) {
      std::size_t last = first;
      std::vector<SettledSection> sections;
      for (; last < own.size() && own[last].owner == own[first].owner; ++last) sections.push_back(own[last].section);
      const std::size_t owner = own[first].owner;
      const std::vector<int> labels = along_[owner].add(sections);
      for (std::size_t k = first; k < last; ++k) branch[k] = place(owner, labels[k - first], value);
      first = last;
    }
    for (std::size_t a = 0; a < own.size(); ++a)
      for (std::size_t b = a + 1; b < own.size(); ++b)
        if (own[a].owner != own[b].owner && own[a].section.motion == own[b].section.motion) {
          std::vector<double>& known = met_[{branch[a], branch[b]}];
          // A dozen values tell; of long branches every eighth one is looked at as well.
          if (known.size() >= kTelling && value % kSparse != 0) continue;
          known.push_back(relative_distance(own[a].section, own[b].section, kAlongParameter));
        }
    for (std::size_t k = 0; k < own.size(); ++k)
      for (const int s : own[k].starts) diagram.run(own[k].owner, value, s)->attractor = branch[k] + 1;
  }

  /// Turns branches into identities, numbered along the parameter.
  void finish(Diagram& diagram) const {
    std::vector<BranchPair> pairs;
    for (const auto& [pair, distances] : met_) pairs.push_back({pair.first, pair.second, distances});
    const std::vector<int> identity = match_branches(branches_, pairs);
    std::vector<std::pair<int, int>> order;  // first value, identity
    for (std::size_t k = 0; k < identity.size(); ++k) {
      const auto one = static_cast<std::size_t>(identity[k]);
      if (one == order.size()) order.emplace_back(branches_[k].values.front(), identity[k]);
      order[one].first = std::min(order[one].first, branches_[k].values.front());
    }
    std::sort(order.begin(), order.end());
    std::vector<int> number(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      number[static_cast<std::size_t>(order[k].second)] = static_cast<int>(k);
    for (DiagramCase& owner : diagram.cases)
      for (DiagramRun& run : owner.runs)
        if (run.attractor > 0)
          run.attractor = number[static_cast<std::size_t>(identity[static_cast<std::size_t>(run.attractor) - 1])] + 1;
    diagram.attractors = static_cast<int>(order.size());
  }

 private:
  static constexpr std::size_t kTelling = 12;
  static constexpr int kSparse = 8;

  int place(std::size_t owner, int label, int value) {
    std::vector<int>& places = first_[owner];
    if (static_cast<std::size_t>(label) == places.size()) {
      places.push_back(static_cast<int>(branches_.size()));
      branches_.push_back({static_cast<int>(owner), {}});
    }
    const int branch = places[static_cast<std::size_t>(label)];
    branches_[static_cast<std::size_t>(branch)].values.push_back(value);
    return branch;
  }

  std::vector<Branches> along_;
  std::vector<std::vector<int>> first_;  ///< case → its branch → index into branches_
  std::vector<CaseBranch> branches_;
  std::map<std::pair<int, int>, std::vector<double>> met_;
};

bool shows(const Diagram& diagram, std::size_t c, int value, int attractor) {
  for (int s = 0; s < diagram.start_count(); ++s)
    if (const DiagramRun* run = diagram.run(c, value, s); run && run->attractor == attractor) return true;
  return false;
}

bool decides(const Diagram& diagram, std::size_t c, int value) {
  for (int s = 0; s < diagram.start_count(); ++s)
    if (const DiagramRun* run = diagram.run(c, value, s); run && run->decided()) return true;
  return false;
}

}  // namespace

void find_attractors(Diagram& diagram, const RunSection& section,
                     const std::function<void(int value, const ValueSections& sections)>& visit) {
  Following following(diagram.cases.size());
  for (int value = 0; value < diagram.value_count(); ++value) {
    ValueSections sections;
    for (std::size_t c = 0; c < diagram.cases.size(); ++c)
      for (int s = 0; s < diagram.start_count(); ++s)
        if (const DiagramRun* run = diagram.run(c, value, s); run && run->settled)
          sections.emplace(std::pair(c, s), section(c, *run));
    if (visit) visit(value, sections);
    following.add(diagram, own_attractors(diagram, sections, value), value);
  }
  following.finish(diagram);
}

std::vector<AttractorExtent> extents_of(const Diagram& diagram) {
  std::vector<AttractorExtent> out(static_cast<std::size_t>(diagram.attractors));
  for (std::size_t c = 0; c < diagram.cases.size(); ++c)
    for (const DiagramRun& run : diagram.cases[c].runs) {
      if (run.attractor == 0) continue;
      AttractorExtent& extent = out[static_cast<std::size_t>(run.attractor) - 1];
      extent.motion = run.motion;
      extent.first = extent.first < 0 ? run.value : std::min(extent.first, run.value);
      extent.last = std::max(extent.last, run.value);
      extent.cases.insert(c);
      extent.values.insert(run.value);
      ++(!run.symmetric ? extent.unknown : *run.symmetric ? extent.symmetric : extent.asymmetric);
    }
  return out;
}

Presence presence_of(const Diagram& diagram, const AttractorExtent& extent, int attractor) {
  Presence out;
  std::vector<double> shares;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    int told = 0, shown = 0;
    for (const int value : extent.values)
      if (decides(diagram, c, value)) {
        ++told;
        shown += shows(diagram, c, value, attractor);
      }
    if (told == 0) continue;
    out.cases.push_back(c);
    shares.push_back(static_cast<double>(shown) / told);
  }
  const double most = shares.empty() ? 0 : *std::max_element(shares.begin(), shares.end());
  for (const double share : shares) out.present.push_back(share > 0 && share >= kHalf * most);
  return out;
}

Proportion fraction_of(const Diagram& diagram, const AttractorExtent& extent, int attractor) {
  std::vector<int> drawn, all;
  for (int s = 0; s < diagram.start_count(); ++s) {
    all.push_back(s);
    if (diagram.starts[static_cast<std::size_t>(s)].random) drawn.push_back(s);
  }
  const std::vector<int>& starts = drawn.size() >= 2 ? drawn : all;
  double reached = 0, tried = 0;
  std::set<int> used;
  for (const std::size_t c : extent.cases)
    for (const int value : extent.values) {
      if (!shows(diagram, c, value, attractor)) continue;
      for (const int s : starts)
        if (const DiagramRun* run = diagram.run(c, value, s); run && run->decided()) {
          ++tried;
          reached += run->attractor == attractor;
          used.insert(s);
        }
    }
  return wilson_interval(tried > 0 ? reached / tried : 0, static_cast<double>(used.size()));
}

std::vector<int> match_changes(const std::vector<DiagramChange>& reference, const std::vector<DiagramChange>& here,
                               double reach) {
  struct Pair {
    double distance;
    std::size_t one, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (std::size_t j = 0; j < here.size(); ++j)
      if (reference[i].like(here[j]) && std::abs(reference[i].value - here[j].value) <= reach)
        pairs.push_back({std::abs(reference[i].value - here[j].value), i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> out(reference.size(), -1);
  std::vector<char> taken(here.size(), 0);
  for (const Pair& pair : pairs)
    if (out[pair.one] < 0 && !taken[pair.other]) {
      out[pair.one] = static_cast<int>(pair.other);
      taken[pair.other] = 1;
    }
  return out;
}

}  // namespace ricochet
