#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runners/report/figure_drawing.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report::ask_figures {
namespace {

/// Rows one below the other, values along the horizontal axis.
class RowFigure : public AskFigure {
 public:
  using AskFigure::AskFigure;

 protected:
  struct Row {
    std::string label;
    bool heading = false;
    double lanes = 1;
    std::function<void(double y)> draw;  // y: of its first lane
  };

  /// All rows under the axis of these values.
  std::string rows(std::vector<Row> all, std::vector<double> values, const std::vector<std::string>& names,
                   bool logarithms, bool boxes = false) {
    values.insert(values.end(), at_.begin(), at_.end());
    if (!logarithms) with_zero(values);
    double longest = 0;
    for (const Row& row : all)
      if (!row.heading) longest = std::max(longest, width_of(row.label));
    const bool beside = longest <= 0.36 * width;
    const double left = beside ? std::max(longest + 2 * gap, 2.5 * side) : 2.5 * side, right = width - 2.5 * side;
    axis_.emplace(values, logarithms, left, right, most_ticks);
    double y = legend(names, 0, boxes);
    y = labels_at(*axis_, y);
    constexpr double tall = 300;  // of the box in which a person sees it
    double height = 0;
    for (const Row& row : all) height += lane * row.lanes + 2 * gap + (beside ? 0 : line_height);
    // Of a tall one the axis is at both ends.
    if (height > tall) y = title(value_title(), y, logarithms) + line_height - gap;
    const double top = y;
    std::vector<std::pair<double, const Row*>> places;
    // Lines lie beneath all that is drawn.
    for (const Row& row : all) {
      places.emplace_back(y, &row);
      const auto lines = static_cast<double>(wrapped(row.label, label_width(row, beside, longest)).size());
      y += row.heading ? line_height * lines + gap
           : beside    ? std::max(line_height * lines, lane * row.lanes) + gap
                       : line_height * lines + lane * row.lanes + gap;
    }
    const double bottom = y;
    if (height > tall) ticks(*axis_, top, top, true);
    ticks(*axis_, top, bottom);
    // Beside labels, and over bars.
    std::vector<Label> labels;
    for (const auto& [from, row] : places) {
      double base = from + line_height - 3;
      for (const std::string& one : wrapped(row->label, label_width(*row, beside, longest))) {
        labels.push_back({side / 2 + width_of(one), base - line_height + 3, base + 3});
        draw_.text(side / 2, base, one, row->heading ? "heading" : "");
        base += line_height;
      }
    }
    if (!boxes) lines_beside(labels, top - 4, bottom);
    for (const auto& [from, row] : places) {
      const std::vector<std::string> lines = wrapped(row->label, label_width(*row, beside, longest));
      if (row->heading || !row->draw) continue;
      const auto count = static_cast<double>(lines.size());
      const double first =
          beside ? from + std::max(0.0, line_height * count - lane * row->lanes) / 2 : from + line_height * count;
      row->draw(first + lane / 2);
    }
    if (boxes) lines_beside(labels, top - 4, bottom);
    const double end = title(value_title(), bottom + line_height, logarithms);
    return draw_.svg(end, value_title());
  }

  void draw(const Mark& mark, const std::string& name, double y, std::size_t series) {
    if (!mark.value) {
      draw_.text(axis_->at(axis_->low()) + gap, y + 4, "no value", "none");
      return;
    }
    if (mark.low) draw_.whisker(axis_->at(*mark.low), axis_->at(*mark.high), y, false, series);
    draw_.sign(axis_->at(*mark.value), y, series, words_of(name, mark, unit_));
  }

  std::optional<FigureAxis> axis_;

 private:
  /// What a line of a label covers, from the left edge on.
  struct Label {
    double right, top, bottom;
  };
  /// Lines at values, interrupted where a label stands; `labels` from the top downwards.
  void lines_beside(const std::vector<Label>& labels, double top, double bottom) {
    for (const double value : at_) {
      const double x = axis_->at(value);
      double from = top;
      for (const Label& one : labels) {
        if (one.right + dot < x || one.bottom < from) continue;
        if (one.top > from) draw_.line(x, from, x, one.top, "at");
        from = one.bottom;
      }
      if (from < bottom) draw_.line(x, from, x, bottom, "at");
    }
  }
  /// Lengths from zero are compared.
  static void with_zero(std::vector<double>& values) {
    if (values.empty()) return;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    constexpr double near = 0.35;
    if (*low > 0 && *low < near * *high) values.push_back(0);
  }
  static double label_width(const Row& row, bool beside, double longest) {
    return beside && !row.heading ? longest + 1 : width - side;
  }
};

class Bars : public RowFigure {
 public:
  using RowFigure::RowFigure;
  std::string svg() override {
    struct One {
      std::string name;
      Mark mark;
    };
    InOrderMet<std::string, std::vector<One>> groups;
    std::vector<double> values;
    for (const Json& row : list_of(figure_, "rows")) {
      groups[text_of(row, "group")].push_back({text_of(row, "name"), Mark(row)});
      groups[text_of(row, "group")].back().mark.add_to(values);
    }
    auto list = std::move(groups).list();
    const bool names = std::any_of(list.begin(), list.end(), [](const auto& group) {
      return std::any_of(group.second.begin(), group.second.end(), [](const One& one) { return !one.name.empty(); });
    });
    // Groups of one row are rows.
    const bool single =
        std::all_of(list.begin(), list.end(), [](const auto& group) { return group.second.size() == 1; });
    std::vector<std::pair<std::string, std::vector<One>>> shown;
    if (single) {
      shown.emplace_back("", std::vector<One>());
      for (auto& [group, ones] : list) {
        One& one = ones.front();
        if (!names)
          one.name = group;
        else if (list.size() > 1 && !group.empty())
          one.name += (one.name.empty() ? "" : ", ") + group;
        shown.front().second.push_back(std::move(one));
      }
    } else {
      shown = std::move(list);
    }
    std::vector<Row> all;
    for (auto& [group, ones] : shown) {
      if (figure_.value("sorted", false))
        std::stable_sort(ones.begin(), ones.end(), [](const One& a, const One& b) {
          return a.mark.value.value_or(-INFINITY) > b.mark.value.value_or(-INFINITY);
        });
      if (shown.size() > 1) all.push_back({group.empty() ? "all" : group, true, 0, {}});
      for (const One& one : ones)
        all.push_back({one.name, false, 1, [this, one](double y) { draw(one.mark, one.name, y, 0); }});
    }
    if (all.empty()) return "";
    std::vector<double> with_lines = values;
    with_lines.insert(with_lines.end(), at_.begin(), at_.end());
    return rows(std::move(all), std::move(values), {}, spans(with_lines, figure_.value("log", false) ? 1 : wide_range));
  }
};

class Pairs : public RowFigure {
 public:
  using RowFigure::RowFigure;
  std::string svg() override {
    InOrderMet<std::string, std::vector<std::pair<std::size_t, Mark>>> pairs;
    InOrderMet<std::string, bool> met;
    std::vector<double> values;
    for (const Json& row : list_of(figure_, "rows")) met[text_of(row, "name")] = true;
    std::vector<std::string> names;
    for (const auto& [name, ignored] : met.list()) names.push_back(name);
    for (const Json& row : list_of(figure_, "rows")) {
      const auto level = std::find(names.begin(), names.end(), text_of(row, "name"));
      auto& marks = pairs[text_of(row, "pair")];
      marks.emplace_back(level - names.begin(), Mark(row));
      marks.back().second.add_to(values);
    }
    std::vector<Row> all;
    for (auto& [pair, marks] : std::move(pairs).list())
      all.push_back({pair, false, static_cast<double>(marks.size()), [this, names, own = std::move(marks)](double y) {
                       std::string way;
                       double at = y;
                       for (const auto& [level, mark] : own) {
                         if (mark.value)
                           way += fmt::format("{}{:.2f} {:.2f}", way.empty() ? "M" : "L", axis_->at(*mark.value), at);
                         at += lane;
                       }
                       if (!way.empty()) draw_.path(way, "joins");
                       for (const auto& [level, mark] : own) {
                         draw(mark, names[level], y, level);
                         y += lane;
                       }
                     }});
    if (all.empty()) return "";
    std::vector<double> with_lines = values;
    with_lines.insert(with_lines.end(), at_.begin(), at_.end());
    constexpr double narrow = 10;
    return rows(std::move(all), std::move(values), names, spans(with_lines, narrow));
  }
};

class Parts : public RowFigure {
 public:
  using RowFigure::RowFigure;
  std::string svg() override {
    InOrderMet<std::string, std::vector<std::pair<std::size_t, double>>> bars;
    InOrderMet<std::string, bool> met;
    for (const Json& row : list_of(figure_, "rows")) met[text_of(row, "part")] = true;
    std::vector<std::string> names;
    for (const auto& [name, ignored] : met.list()) names.push_back(name);
    std::vector<double> values = {0};
    for (const Json& row : list_of(figure_, "rows")) {
      const auto part = std::find(names.begin(), names.end(), text_of(row, "part"));
      auto& parts = bars[text_of(row, "name")];
      if (const auto value = number_of(row, "value")) parts.emplace_back(part - names.begin(), std::max(0.0, *value));
    }
    std::vector<Row> all;
    for (auto& [name, parts] : std::move(bars).list()) {
      double sum = 0;
      for (const auto& [part, value] : parts) sum += value;
      values.push_back(sum);
      all.push_back({name, false, 1.3, [this, names, own = std::move(parts)](double y) {
                       double from = 0;
                       for (const auto& [part, value] : own) {
                         draw_.box(axis_->at(from), y - lane / 2, axis_->at(from + value) - axis_->at(from), lane,
                                   fmt::format("part s{}", part % colours),
                                   fmt::format("{}: {} {}", names[part], number_text(value, 3), unit_));
                         from += value;
                       }
                       if (own.empty()) draw_.text(axis_->at(0) + gap, y + 4, "no value", "none");
                     }});
    }
    if (all.empty()) return "";
    return rows(std::move(all), std::move(values), names, false, true);
  }
};

/// Stretches of an axis, a row for each name.
class Ranges : public RowFigure {
 public:
  using RowFigure::RowFigure;
  std::string svg() override {
    struct Stretch {
      std::size_t group = 0;
      std::string motion;
      double from = 0, to = 0;
    };
    InOrderMet<std::string, std::vector<Stretch>> met;
    std::vector<std::string> groups;
    std::vector<double> values;
    for (const Json& row : list_of(figure_, "rows")) {
      const std::string motion = text_of(row, "motion"), own = text_of(row, "group"),
                        group = own.empty() ? motion : own;
      auto place = std::find(groups.begin(), groups.end(), group);
      if (place == groups.end()) {
        place = groups.insert(place, group);
        if (!own.empty()) colours_.push_back(text_of(row, "colour"));
      }
      auto& stretches = met[text_of(row, "name")];
      const auto from = number_of(row, "from"), to = number_of(row, "to");
      if (!from || !to) continue;
      stretches.push_back({static_cast<std::size_t>(place - groups.begin()), motion, *from, *to});
      values.insert(values.end(), {*from, *to});
    }
    std::vector<Row> all;
    for (auto& [name, stretches] : std::move(met).list())
      all.push_back({name, false, 1.3, [this, own = std::move(stretches)](double y) {
                       for (const Stretch& one : own) {
                         constexpr double least = 1.5;  // one value alone is seen, too
                         const double from = axis_->at(one.from), wide = std::max(axis_->at(one.to) - from, least);
                         draw_.box(from, y - lane / 2, wide, lane, fmt::format("part s{}", one.group % colours),
                                   fmt::format("{}: {} to {}", one.motion, number_text(one.from), number_text(one.to)),
                                   colours_.empty() ? "" : colours_[one.group]);
                       }
                       if (own.empty()) draw_.text(axis_->at(axis_->low()) + gap, y + 4, "no value", "none");
                     }});
    if (all.empty()) return "";
    return rows(std::move(all), std::move(values), groups, false, true);
  }
};

}  // namespace

std::string row_figure(const std::string& form, const Json& figure) {
  if (form == "bars") return Bars(figure).svg();
  if (form == "pairs") return Pairs(figure).svg();
  if (form == "parts") return Parts(figure).svg();
  return form == "ranges" ? Ranges(figure).svg() : "";
}

}  // namespace ricochet::report::ask_figures
