#include "runners/report/method_curves.hpp"

#include <algorithm>
#include <array>

#include "runners/report/options.hpp"

namespace ricochet::report {
namespace {

constexpr size_t curves_per_chart = 8;
constexpr std::array colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7B4FA0", "#8C6D31"};

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

bool of_method(const std::string& column) {
  const std::string role = role_of(column);
  return role == "mass" || role == "contact" || role == "time";
}

}  // namespace

MethodCurves::MethodCurves(const CaseView& view, const Cases& cases, const std::string& along,
                           const std::vector<std::string>& apart, const std::vector<std::string>& ignored)
    : by_mass_(view.masses().size() > 1) {
  std::vector<std::string> others, facet_columns, candidates;
  for (const std::string& column : view.varying())
    if (column != along && !contains(ignored, column)) others.push_back(column);
  for (const std::string& column : others)
    if (contains(apart, column)) facet_columns.push_back(column);
  for (const bool methods : {false, true})
    for (const std::string& column : others)
      if (!contains(apart, column) && role_of(column) != "mass" && of_method(column) == methods)
        candidates.push_back(column);
  for (const std::string& column : candidates) {
    size_t most = 0;
    for (const CaseGroup& facet : view.group(cases, facet_columns))
      most = std::max(most, view.group(facet.cases, others).size());
    if (most <= curves_per_chart) break;
    facet_columns.push_back(column);
  }

  std::vector<std::string> curve_columns, not_mass;
  for (const std::string& column : others) {
    if (!contains(facet_columns, column)) curve_columns.push_back(column);
    if (role_of(column) != "mass") not_mass.push_back(column);
  }
  said_ = {along};
  said_.insert(said_.end(), curve_columns.begin(), curve_columns.end());
  std::vector<std::string> names;
  for (const CaseGroup& group : view.group(cases, facet_columns)) {
    MethodFacet facet{group.label.empty() ? "all cases" : group.label, group.cases, {}};
    const std::vector<CaseGroup> styles = view.group(group.cases, not_mass);
    for (CaseGroup& one : view.group(group.cases, others)) {
      const CaseRecord* first = one.cases.front();
      const auto style = std::find_if(styles.begin(), styles.end(), [&](const CaseGroup& s) {
        return std::find(s.cases.begin(), s.cases.end(), first) != s.cases.end();
      });
      std::stable_sort(one.cases.begin(), one.cases.end(), [&](const CaseRecord* a, const CaseRecord* b) {
        return CaseView::number(*a, along).value_or(0) < CaseView::number(*b, along).value_or(0);
      });
      std::string name = view.label(*first, curve_columns);
      if (name.empty()) name = view.mass_label(*first);
      if (name.empty()) name = "cases";
      // Without masses to tell apart, a name has its colour in every chart.
      const auto known = std::find(names.begin(), names.end(), name);
      const auto rank = static_cast<size_t>(known - names.begin());
      if (known == names.end()) names.push_back(name);
      facet.curves.push_back({std::move(name), by_mass_ ? view.colour(*first) : colours[rank % colours.size()],
                              by_mass_ ? static_cast<size_t>(style - styles.begin()) : rank, std::move(one.cases)});
    }
    facets_.push_back(std::move(facet));
  }
}

std::vector<LegendEntry> MethodCurves::legend() const {
  std::vector<LegendEntry> out;
  for (const MethodFacet& facet : facets_)
    for (const MethodCurve& curve : facet.curves)
      if (std::none_of(out.begin(), out.end(), [&](const LegendEntry& e) { return e.name == curve.name; }))
        out.push_back({curve.name, curve.colour, svg_dash(curve.style), symbol(curve.style)});
  return out;
}

std::string MethodCurves::colours_text() const {
  return by_mass_ ? "One colour per mass matrix." : "One colour per curve (the study has one mass matrix).";
}

}  // namespace ricochet::report
