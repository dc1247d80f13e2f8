#include "runners/asks/default_asks.hpp"

#include <algorithm>
#include <cmath>

#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet::asks {

std::vector<Ask> asks_of_measures(const Evidence& evidence, const std::vector<std::string>& measures, bool runs) {
  constexpr std::size_t most = 4;
  Json list = Json::array();
  if (runs) list.push_back({{"runs", true}});
  for (std::size_t k = 0; k < std::min(measures.size(), most); ++k) list.push_back({{"value", measures[k]}});
  const std::string& compared = evidence.study().asked();
  if (!compared.empty() && compared != "all" && !measures.empty())
    list.push_back({{"effect", compared}, {"on", measures.front()}});
  return asks_of_list(list);
}

std::vector<std::string> proposals(const Evidence& evidence, const std::vector<std::string>& measures) {
  std::vector<std::string> out;
  if (measures.empty()) return out;
  const std::string& first = measures.front();
  const auto [base, stop] = split_measure(first);
  const Cases cases = evidence.cases(ask_of({{"value", first}}, 1));
  const std::vector<std::string> choices = evidence.choices(cases, first);
  if (!choices.empty()) out.push_back(Json({{"effect", choices.front()}, {"on", first}, {"from", "5 %"}}).dump());
  if (!stop.empty() && evidence.measures(ask_of({{"rank", base}, {"over", "stops"}}, 1), base).size() > 1)
    out.push_back(Json({{"rank", base}, {"over", "stops"}}).dump());
  const MeasureInfo* info = measure_info(first);
  std::vector<double> values;
  for (const CaseRecord* record : cases)
    if (const auto value = measure(*record, first); value && std::isfinite(*value)) values.push_back(*value);
  // A limit a tenth beyond all values, on the side that counts.
  if (!values.empty()) {
    const bool from_below = info && info->reading.direction > 0;
    const double end =
        from_below ? *std::min_element(values.begin(), values.end()) : *std::max_element(values.begin(), values.end());
    constexpr double beyond = 0.1;
    const double limit = end + (from_below ? -beyond : beyond) * std::abs(end);
    if (limit != 0)
      out.push_back(Json({{"limit", first}, {from_below ? "above" : "below", to_digits(limit, 2)}}).dump());
  }
  if (!info || !info->of_each_size) out.push_back(Json({{"enough", first}, {"within", "5 %"}}).dump());
  constexpr std::size_t three = 3;
  out.resize(std::min(out.size(), three));
  return out;
}

}  // namespace ricochet::asks
