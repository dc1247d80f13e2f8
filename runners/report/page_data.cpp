#include "runners/report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "runners/report/curve_data.hpp"
#include "runners/report/quantity.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::report {
namespace {

using PageJson = nlohmann::ordered_json;

PageJson column_json(const Column& column) {
  return {{"name", column.name}, {"unit", column.unit}, {"text", column.text}};
}

/// Words are written once each, numbers as they are.
PageJson packed(PageJson cells) {
  const bool words =
      std::all_of(cells.begin(), cells.end(), [](const PageJson& c) { return c.is_string() || c.is_null(); });
  if (!words || cells.empty()) return cells;
  PageJson list = PageJson::array(), at = PageJson::array();
  std::map<std::string, int> places;
  for (const PageJson& cell : cells) {
    if (cell.is_null()) {
      at.push_back(-1);
      continue;
    }
    const auto [place, fresh] = places.emplace(cell.get<std::string>(), static_cast<int>(list.size()));
    if (fresh) list.push_back(cell);
    at.push_back(place->second);
  }
  return {{"words", std::move(list)}, {"at", std::move(at)}};
}

PageJson table_json(const Table& table) {
  PageJson columns = PageJson::array(), cells = PageJson::array();
  for (size_t c = 0; c < table.columns.size(); ++c) {
    columns.push_back(column_json(table.columns[c]));
    PageJson column = PageJson::array();
    for (const auto& row : table.rows) column.push_back(c < row.size() ? json_of(row[c]) : PageJson());
    cells.push_back(packed(std::move(column)));
  }
  return {{"columns", std::move(columns)}, {"rows", table.rows.size()}, {"cells", std::move(cells)}};
}

PageJson axes_json(const Choices& choices) {
  PageJson out = PageJson::array();
  for (const std::string& column : choices.results().columns) {
    const std::vector<std::string>& texts = choices.values(column);
    PageJson numbers(texts.size(), nullptr), at = PageJson::array();
    std::vector<char> met(texts.size(), 0);
    for (const CaseRecord& record : choices.results().cases) {
      const auto place = choices.place(record, column);
      at.push_back(place ? PageJson(*place) : PageJson(-1));
      if (!place || std::exchange(met[*place], 1) != 0) continue;
      if (const auto number = axis(record, column).number()) numbers[*place] = *number;
    }
    out.push_back({{"name", column},
                   {"said", axis_text(choices.results(), column)},
                   {"role", axis_role(column)},
                   {"word", label_word(column)},
                   {"unit", choices.unit_of(column)},
                   {"varies", choices.varies(column)},
                   {"texts", texts},
                   {"numbers", std::move(numbers)},
                   {"at", std::move(at)}});
  }
  return out;
}

PageJson cases_json(const Choices& choices) {
  PageJson out = {{"id", PageJson::array()},          {"status", PageJson::array()},
                  {"reason", PageJson::array()},      {"partial", PageJson::array()},
                  {"steps", PageJson::array()},       {"setup_seconds", PageJson::array()},
                  {"run_seconds", PageJson::array()}, {"mass", PageJson::array()},
                  {"colour", PageJson::array()},      {"measures", PageJson::object()}};
  const Cases all = all_cases(choices.results());
  for (size_t c = 0; c < all.size(); ++c) {
    const CaseRecord& record = *all[c];
    out["id"].push_back(record.id);
    out["status"].push_back(word(record.status));
    out["reason"].push_back(record.reason());
    out["partial"].push_back(record.partial);
    out["steps"].push_back(record.steps);
    out["setup_seconds"].push_back(record.setup_seconds);
    out["run_seconds"].push_back(record.run_seconds);
    out["mass"].push_back(choices.mass_place(record));
    out["colour"].push_back(choices.colour(record));
    for (const auto& [name, value] : record.measures) {
      PageJson& column = out["measures"][name];
      if (column.is_null()) column = PageJson(all.size(), nullptr);
      column[c] = value;
    }
  }
  return out;
}

PageJson measures_json(const PageJson& cases) {
  PageJson out = PageJson::array();
  for (const auto& [name, column] : cases["measures"].items()) {
    PageJson one = column_json(measure_column(name));
    if (const MeasureInfo* info = measure_info(name); info && *info->reading.words != 0)
      one["words"] = info->reading.words;
    out.push_back(std::move(one));
  }
  return out;
}

/// The measure that the answer speaks of first; "" where it speaks of none.
std::string answered_measure(const StudyResults& results) {
  const std::vector<answers::Clause> said = answers::answers_type().read(results.derived);
  return said.empty() ? "" : said.front().measure;
}

PageJson tables_json(const Choices& choices, const KindPage& kind) {
  PageJson out = PageJson::object();
  std::vector<std::string_view> names = kind.tables;
  names.insert(names.end(), {"differences", "effects", "effects_said"});
  for (const std::string_view name : names)
    if (const Table* table = find_table(choices.results().derived, name)) out[table->name] = table_json(*table);
  return out;
}

PageJson own_json(const Choices& choices, const KindPage& kind) {
  PageJson out = PageJson::object();
  for (const CaseRecord* record : all_cases(choices.results()))
    for (const std::string_view name : kind.own_tables)
      if (const Table* table = find_table(record->tables, name))
        out[std::string(name)][record->id] = table_json(*table);
  return out;
}

PageJson curves_json(const Choices& choices, const KindPage& kind, const CurveChoice& choice, CurveData& curves) {
  PageJson out = PageJson::object();
  for (const CaseRecord* record : all_cases(choices.results()))
    for (const std::string_view column : kind.curves)
      if (choice.holds(record->id))
        if (auto names = curves.series(*record, "t", std::string(column)))
          out[record->id][std::string(column)] = std::move(*names);
  return out;
}

/// Cases that are sampled at the same times share these.
void share_times(PageJson& curves, Blocks& blocks) {
  std::map<std::string, std::string> first, of;  // bytes → the first block with them; block → that one
  for (auto& [id, columns] : curves.items())
    for (auto& [column, names] : columns.items()) {
      const std::string name = names[0].get<std::string>(), key = name + ":f64";
      if (const auto block = blocks.find(key); !of.count(name) && block != blocks.end()) {
        const auto [known, fresh] = first.emplace(block->second, name);
        of[name] = known->second;
        if (!fresh) blocks.erase(key);
      }
      names[0] = of[name];
    }
}

}  // namespace

PageData page_data(const Choices& choices, const KindPage& kind, const StudyResults& all) {
  const StudyResults& results = choices.results();
  size_t series = 0;
  const CurveChoice choice(choices, all);
  for (const CaseRecord& record : results.cases)
    if (!record.curve.columns.empty() && choice.holds(record.id)) series += kind.curves.size() + 1;
  CurveData curves(sample_limit(series));
  PageJson out = {{"study", {{"name", results.name}, {"kind", results.kind}, {"resolved", results.study}}}};
  out["axes"] = axes_json(choices);
  out["roles"] = method_roles();
  out["masses"] = choices.masses();
  out["words"] = results.method_words;
  out["cases"] = cases_json(choices);
  out["measures"] = measures_json(out["cases"]);
  out["tables"] = tables_json(choices, kind);
  out["own"] = own_json(choices, kind);
  out["curves"] = curves_json(choices, kind, choice, curves);
  out["curve_files"] = has_curve_files(all);
  out["panel"] = panel_data(choices, curves);
  out["snapshots"] = snapshot_data(choices, curves);
  if (kind.data) out[kind.data_key] = kind.data(choices, curves);
  std::string less = kind.curves.empty() ? "" : choice.sentence();
  if (const std::string thinned = curves.thinning(has_curve_files(all)); !thinned.empty())
    less += (less.empty() ? "" : " ") + thinned;
  Blocks blocks = curves.blocks();
  share_times(out["curves"], blocks);
  return {std::move(out), std::move(blocks), std::move(less)};
}

namespace {

constexpr std::size_t most_curve_rows = 24, most_curve_cases = 96, at_an_end = 8;

/// Places of `count` groups: both ends of what is measured, then evenly over all.
std::set<std::size_t> chosen(const std::vector<CaseGroup>& groups, const std::string& name) {
  std::vector<std::pair<double, std::size_t>> known;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const CaseRecord* record : groups[g].cases)
      if (const auto value = ricochet::measure(*record, name); value && record->status == Status::done)
        known.emplace_back(*value, g);
  std::sort(known.begin(), known.end());
  std::set<std::size_t> out;
  for (std::size_t k = 0; k < known.size() && out.size() < at_an_end; ++k) out.insert(known[k].second);
  for (std::size_t k = known.size(); k > 0 && out.size() < 2 * at_an_end; --k) out.insert(known[k - 1].second);
  const std::size_t even = most_curve_rows - out.size();
  for (std::size_t k = 0; k < even; ++k) out.insert(k * groups.size() / even);
  return out;
}

}  // namespace

CurveChoice::CurveChoice(const Choices& choices, const StudyResults& all) {
  Cases drawn;
  for (const CaseRecord* record : all_cases(choices.results()))
    if (!record->curve.columns.empty()) drawn.push_back(record);
  with_curves_ = drawn.size();
  files_ = has_curve_files(all);
  where_ = where_curves_are(all);
  const std::vector<CaseGroup> groups = choices.group(drawn, choices.varying_without({"step"}));
  all_ = groups.size() <= most_curve_rows || drawn.size() <= most_curve_cases;
  if (all_) return;
  for (const std::size_t place : chosen(groups, answered_measure(choices.results())))
    for (const CaseRecord* record : groups[place].cases) ids_.insert(record->id);
}

std::string CurveChoice::sentence() const {
  if (all_) return files_ ? "" : fmt::format("Curves over time: {}.", where_);
  return fmt::format(
      "Curves over time: this page holds those of {} of {} cases, the extreme ones and others spread over the study; "
      "{}.",
      ids_.size(), with_curves_, where_);
}

}  // namespace ricochet::report
