#include "runners/run/part_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace ricochet {
namespace {

/// What is left of a prediction when the last digits of processors are not told apart.
double three_digits(double seconds) {
  return std::stod(fmt::format("{:.2e}", seconds));
}

}  // namespace

void check_part(const Study& study, const StudyPart& part) {
  const auto cases = std::count_if(study.cases.begin(), study.cases.end(),
                                   [](const StudyCase& one) { return !one.excluded.has_value(); });
  if (cases >= part.of) return;
  throw PartRefused(fmt::format("{}: this study has {} case{} to run: at most {} part{}, not {}", study.name, cases,
                                cases == 1 ? "" : "s", cases, cases == 1 ? "" : "s", part.of));
}

std::vector<const StudyCase*> cases_of_part(const Study& study, const StudyPart& part,
                                            const std::map<std::string, double>& seconds) {
  std::vector<double> costs;
  for (const StudyCase& one : study.cases) {
    const auto found = seconds.find(one.id);
    costs.push_back(one.excluded ? -1 : found == seconds.end() ? 0 : three_digits(found->second));
  }
  std::vector<std::size_t> order(study.cases.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return costs[a] != costs[b] ? costs[a] > costs[b] : study.cases[a].id < study.cases[b].id;
  });
  std::vector<std::size_t> own;
  const auto step = static_cast<std::size_t>(part.of);
  for (std::size_t rank = static_cast<std::size_t>(part.number) - 1; rank < order.size(); rank += step)
    own.push_back(order[rank]);
  std::sort(own.begin(), own.end());
  std::vector<const StudyCase*> cases;
  for (const std::size_t i : own) cases.push_back(&study.cases[i]);
  return cases;
}

}  // namespace ricochet
