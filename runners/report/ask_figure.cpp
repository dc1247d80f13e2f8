#include "runners/report/ask_figure.hpp"

#include <fmt/format.h>

#include "runners/report/figure_drawing.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report {

std::string figure_svg(const nlohmann::ordered_json& figure) {
  if (!figure.is_object()) return "";
  const std::string form = ask_figures::text_of(figure, "form"), rows = ask_figures::row_figure(form, figure);
  return rows.empty() ? ask_figures::plane_figure(form, figure) : rows;
}

namespace {

using Json = nlohmann::ordered_json;

/// Rows whose columns are those met.
class MarkTable {
 public:
  void add(const std::vector<std::pair<std::string, Json>>& cells) {
    Row& row = table_.rows.emplace_back(table_.columns.size());
    for (const auto& [name, value] : cells) {
      const std::size_t place = column(name);
      if (row.size() <= place) row.resize(place + 1);
      row[place] = cell_of(value);
    }
  }
  std::string csv() {
    for (Row& row : table_.rows) row.resize(table_.columns.size());
    return table_.rows.empty() ? "" : table_csv(table_);
  }

 private:
  std::size_t column(const std::string& name) {
    if (const auto known = find_column(table_.columns, name)) return *known;
    table_.columns.push_back({name, "", ""});
    return table_.columns.size() - 1;
  }

  Table table_{"figure", "", {}, {}};
};

std::string unit_behind(const std::string& name, const Json& figure, const char* unit) {
  const std::string text = ask_figures::text_of(figure, unit);
  return text.empty() ? name : fmt::format("{} ({})", name, text);
}

}  // namespace

std::string figure_csv(const Json& figure) {
  if (!figure.is_object()) return "";
  MarkTable table;
  const bool plane = figure.contains("series");
  const std::string y = plane ? unit_behind(ask_figures::text_of(figure, "y"), figure, "y_unit")
                              : unit_behind("value", figure, "unit"),
                    x = unit_behind(plane ? ask_figures::text_of(figure, "x") : "x", figure,
                                    figure.contains("along_unit") ? "along_unit" : "x_unit");
  const auto named = [&](const std::string& key) {
    return key == "value"                  ? y
           : key == "low" || key == "high" ? unit_behind(key, figure, "unit")
           : key == "x"                    ? x
           : key == "from" || key == "to"  ? unit_behind(key, figure, "x_unit")
                                           : key;
  };
  for (const Json& row : figure.value("rows", Json::array())) {
    std::vector<std::pair<std::string, Json>> cells;
    for (const auto& [key, value] : row.items()) cells.emplace_back(named(key), value);
    table.add(cells);
  }
  for (const Json& one : figure.value("series", Json::array())) {
    for (const Json& point : one.value("points", Json::array())) {
      std::vector<std::pair<std::string, Json>> cells = {{"name", one.at("name")}, {x, point.at(0)}, {y, point.at(1)}};
      if (point.size() > 2) cells.emplace_back("stable", point.at(2));
      table.add(cells);
    }
    if (one.contains("floor")) table.add({{"name", one.at("name")}, {"floor", one.at("floor")}});
  }
  for (const Json& mark : figure.value("marks", Json::array()))
    table.add({{"name", mark.at("name")}, {"mark", mark.at("kind")}, {x, mark.at("value")}, {y, mark.at("tip")}});
  for (const Json& at : figure.value("at", Json::array())) table.add({{"mark", "at"}, {y, at}});
  return table.csv();
}

}  // namespace ricochet::report
