#include <algorithm>

#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/kinds/convergence/convergence.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/kinds/work-precision/work_precision.hpp"

namespace ricochet {
namespace {

/// The kinds, and what is asked of all of them together.
struct Registered {
  std::vector<Kind> kinds;
  std::vector<MeasureInfo> measures;
  void add(Kind kind) {
    measures.insert(measures.end(), kind.measures.begin(), kind.measures.end());
    kinds.push_back(std::move(kind));
  }
};

Registered& registered() {
  static Registered all = [] {
    Registered built_in;
    // A new kind is one more line here.
    for (Kind (*make)() :
         {trajectory_kind, convergence_kind, work_precision_kind, stability_kind, bifurcation_kind, basins_kind})
      built_in.add(make());
    return built_in;
  }();
  return all;
}

}  // namespace

const std::vector<Kind>& kinds() {
  return registered().kinds;
}

void add_kind(Kind kind) {
  if (find_kind(kind.format.name)) throw std::logic_error("there is a kind \"" + kind.format.name + "\" already");
  registered().add(std::move(kind));
}

const Kind* find_kind(const std::string& name) {
  const auto found =
      std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) { return kind.format.name == name; });
  return found == kinds().end() ? nullptr : &*found;
}

report::KindPage page_of(const std::string& kind) {
  const Kind* known = find_kind(kind);
  return known && known->page ? known->page() : report::KindPage();
}

std::vector<const StudyKind*> study_kinds() {
  std::vector<const StudyKind*> formats;
  for (const Kind& kind : kinds()) formats.push_back(&kind.format);
  return formats;
}

const std::vector<MeasureInfo>& all_measures() {
  return registered().measures;
}

const MeasureInfo* measure_info(const std::string& name) {
  const auto& all = all_measures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const MeasureInfo& info) { return name == info.name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> standing_measures(const std::string& kind) {
  std::vector<std::string> names;
  if (const Kind* known = find_kind(kind); known && known->measures_stand)
    for (const MeasureInfo& info : known->measures) names.emplace_back(info.name);
  return names;
}

}  // namespace ricochet
