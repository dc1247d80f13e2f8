#include "runners/report/ask_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "runners/report/case_view.hpp"
#include "runners/report/figure_axis.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

namespace ricochet::report::ask_figures {
namespace {

using Json = nlohmann::ordered_json;

// Units of the drawing are pixels of a phone; a wide screen draws it larger and its letters smaller.
constexpr double width = 400, letter = 12, line_height = 15, side = 8, glyph = 0.62 * letter;
constexpr double dot = 4, lane = 11, gap = 6, end_of_whisker = 3;
constexpr int most_ticks = 5;
constexpr std::size_t colours = 8;

double width_of(const std::string& text) {
  return glyph * static_cast<double>(shown_width(text));
}

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> number_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number() || !std::isfinite(found->get<double>())) return std::nullopt;
  return found->get<double>();
}

std::vector<double> numbers_of(const Json& object, const char* key) {
  std::vector<double> out;
  if (const auto found = object.find(key); found != object.end() && found->is_array())
    for (const Json& one : *found)
      if (one.is_number() && std::isfinite(one.get<double>())) out.push_back(one.get<double>());
  return out;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

/// A value with its interval.
struct Mark {
  std::optional<double> value, low, high;
  explicit Mark(const Json& row)
      : value(number_of(row, "value")), low(number_of(row, "low")), high(number_of(row, "high")) {
    if (!low || !high) low = high = std::nullopt;
  }
  void add_to(std::vector<double>& all) const {
    for (const auto& one : {value, low, high})
      if (one) all.push_back(*one);
  }
};

/// "HRZ: 97.03 (96.97 to 97.1)".
std::string words_of(const std::string& name, const Mark& mark, const std::string& unit) {
  std::string out = name.empty() ? "" : name + ": ";
  out += mark.value ? number_text(*mark.value, 5) : "no value";
  if (mark.low) out += fmt::format(" ({} to {})", number_text(*mark.low, 5), number_text(*mark.high, 5));
  return out + (unit.empty() || !mark.value ? "" : " " + unit);
}

/// Words in lines that are no wider.
std::vector<std::string> wrapped(const std::string& text, double most) {
  std::vector<std::string> lines{""};
  std::size_t at = 0;
  const std::string plain = plain_text(text);
  while (at < plain.size()) {
    const std::size_t end = std::min(plain.find(' ', at), plain.size());
    std::string word = plain.substr(at, end - at);
    at = end + 1;
    if (!lines.back().empty() && width_of(lines.back() + " " + word) > most) lines.emplace_back();
    // A word that no line holds is cut.
    while (width_of(word) > most) {
      std::size_t cut = 0;
      for (std::size_t shown = 0; cut < word.size(); ++cut) {
        if ((static_cast<unsigned char>(word[cut]) & 0xC0) != 0x80 && glyph * static_cast<double>(++shown) > most)
          break;
      }
      if (cut == 0) break;
      if (!lines.back().empty()) lines.emplace_back();
      lines.back() = word.substr(0, cut);
      word.erase(0, cut);
      if (!word.empty()) lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

class Drawing {
 public:
  void line(double x1, double y1, double x2, double y2, const std::string& classes) {
    out_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" class=\"{}\"/>\n", x1, y1, x2,
                        y2, classes);
  }
  void box(double x, double y, double w, double h, const std::string& classes, const std::string& title = "") {
    out_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" class=\"{}\">{}</rect>\n",
                        x, y, w, h, classes, titled(title));
  }
  /// `anchor`: "start", "middle" or "end"; y of the base line.
  void text(double x, double y, const std::string& words, const std::string& classes = "",
            const char* anchor = "start") {
    out_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\"{}{}>{}</text>\n", x, y,
                        anchor == std::string_view("start") ? "" : fmt::format(" text-anchor=\"{}\"", anchor),
                        classes.empty() ? "" : fmt::format(" class=\"{}\"", classes), escape(words));
  }
  /// The sign of a series: its colour and, of those of one colour, its shape.
  void sign(double x, double y, std::size_t series, const std::string& title = "") {
    const std::string classes = fmt::format("dot s{}", series % colours);
    const double d = dot;
    switch (series % 4) {
      case 0:
        out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" class=\"{}\">{}</circle>\n", x, y, d,
                            classes, titled(title));
        break;
      case 1:
        box(x - 0.9 * d, y - 0.9 * d, 1.8 * d, 1.8 * d, classes, title);
        break;
      case 2:
        path(fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}h{:.2f}z", x, y - 1.1 * d, 1.1 * d, 2 * d, -2.2 * d), classes,
             title);
        break;
      default:
        path(fmt::format("M{:.2f} {:.2f}l{:.2f} {:.2f}l{:.2f} {:.2f}l{:.2f} {:.2f}z", x, y - 1.2 * d, 1.2 * d, 1.2 * d,
                         -1.2 * d, 1.2 * d, -1.2 * d, -1.2 * d),
             classes, title);
    }
  }
  void path(const std::string& d, const std::string& classes, const std::string& title = "") {
    out_ += fmt::format("<path d=\"{}\" class=\"{}\">{}</path>\n", d, classes, titled(title));
  }
  /// `along` a value from low to high, `across` it at a place; upright where values are.
  void whisker(double low, double high, double across, bool upright, std::size_t series) {
    const std::string classes = fmt::format("whisker s{}", series % colours);
    const double e = end_of_whisker;
    std::string d;
    if (upright)
      d = fmt::format("M{0:.2f} {1:.2f}V{2:.2f}M{3:.2f} {1:.2f}h{4:g}M{3:.2f} {2:.2f}h{4:g}", across, low, high,
                      across - e, 2 * e);
    else
      d = fmt::format("M{0:.2f} {1:.2f}H{2:.2f}M{0:.2f} {3:.2f}v{4:g}M{2:.2f} {3:.2f}v{4:g}", low, across, high,
                      across - e, 2 * e);
    path(d, classes);
  }
  /// The whole, so high.
  std::string svg(double height, const std::string& label) const {
    return fmt::format(
        "<svg class=\"ask-figure\" viewBox=\"0 0 {:g} {:.0f}\" role=\"img\" aria-label=\"{}\" "
        "xmlns=\"http://www.w3.org/2000/svg\">\n{}</svg>\n",
        width, std::ceil(height), escape(label), out_);
  }

 private:
  static std::string titled(const std::string& title) {
    return title.empty() ? "" : "<title>" + escape(title) + "</title>";
  }
  std::string out_;
};

/// What the drawings of all forms have: an axis title, lines `at` that are labelled, a legend.
class AskFigure {
 public:
  explicit AskFigure(const Json& figure)
      : figure_(figure), unit_(shown_unit(text_of(figure, "unit"))), at_(numbers_of(figure, "at")) {
    std::sort(at_.begin(), at_.end());
    at_.erase(std::unique(at_.begin(), at_.end()), at_.end());
  }
  virtual ~AskFigure() = default;
  AskFigure(const AskFigure&) = delete;
  AskFigure& operator=(const AskFigure&) = delete;
  virtual std::string svg() = 0;

 protected:
  std::string value_title() const { return with_unit({text_of(figure_, "measure"), unit_}); }
  /// Names of series with their signs, from `top` downwards; where it ends.
  double legend(const std::vector<std::string>& names, double top, bool boxes = false) {
    if (names.size() < 2 && (names.empty() || names.front().empty())) return top;
    double x = side, y = top + line_height;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const std::vector<std::string> lines = wrapped(names[k], width - 2 * side - 2 * lane);
      const double wide = 2 * lane + width_of(lines.front());
      if (x > side && (x + wide > width - side || lines.size() > 1)) x = side, y += line_height;
      if (boxes)
        draw_.box(x, y - 9, 9, 9, fmt::format("part s{}", k % colours));
      else
        draw_.sign(x + dot, y - dot, k);
      for (std::size_t l = 0; l < lines.size(); ++l)
        draw_.text(x + 1.4 * lane, y + (l == 0 ? 0 : line_height) * static_cast<double>(l), lines[l]);
      x += wide + gap;
      if (lines.size() > 1)
        x = side, y += line_height * static_cast<double>(lines.size() - (k + 1 == names.size() ? 1 : 0));
    }
    return y + gap;
  }
  /// The labels of upright lines at values, above `top`'s end; where they end.
  double labels_at(const FigureAxis& axis, double top) {
    double end = top;
    std::vector<double> ends;  // of each line of labels, where its last one ends
    for (const double value : at_) {
      const std::string words = number_text(value, 4) + (unit_.empty() ? "" : " " + unit_);
      const double wide = width_of(words), x = std::clamp(axis.at(value) - wide / 2, side / 2, width - side / 2 - wide);
      std::size_t row = 0;
      while (row < ends.size() && ends[row] + gap > x) ++row;
      if (row == ends.size()) ends.push_back(0);
      ends[row] = x + wide;
      const double y = top + line_height * static_cast<double>(row + 1);
      draw_.text(x + wide / 2, y, words, "at", "middle");
      end = std::max(end, y + 4);
    }
    return end;
  }
  void lines_at(const FigureAxis& axis, double top, double bottom) {
    for (const double value : at_) draw_.line(axis.at(value), top, axis.at(value), bottom, "at");
  }
  /// The ticks of a horizontal axis, with lines up to `top`; words below y, or above it.
  void ticks(const FigureAxis& axis, double top, double y, bool above = false) {
    double end = -1;
    for (const auto& [value, words] : axis.ticks()) {
      const double x = axis.at(value), wide = width_of(words), from = std::clamp(x - wide / 2, 0.0, width - wide);
      draw_.line(x, top, x, y, "grid");
      if (from <= end) continue;
      draw_.text(from + wide / 2, above ? y - 4 : y + line_height - 1, words, "tick", "middle");
      end = from + wide + 2;
    }
  }
  /// A title below an axis; where it ends.
  double title(const std::string& words, double y, bool logarithms) {
    for (const std::string& one : wrapped(words + (logarithms ? ", logarithmic" : ""), width - 2 * side)) {
      y += line_height;
      draw_.text(width / 2, y, one, "title", "middle");
    }
    return y + gap;
  }

  const Json& figure_;
  std::string unit_;
  std::vector<double> at_;
  Drawing draw_;
};

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
    double longest = 0;
    for (const Row& row : all)
      if (!row.heading) longest = std::max(longest, width_of(row.label));
    const bool beside = longest <= 0.36 * width;
    const double left = beside ? std::max(longest + 2 * gap, 2.5 * side) : 2.5 * side, right = width - 2.5 * side;
    axis_.emplace(values, logarithms, left, right, most_ticks);
    double y = legend(names, 0, boxes);
    y = labels_at(*axis_, y);
    constexpr double tall = 420;
    double height = 0;
    for (const Row& row : all) height += lane * row.lanes + 2 * gap + (beside ? 0 : line_height);
    if (height > tall) y += line_height;
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
    lines_at(*axis_, top - 4, bottom);
    for (const auto& [from, row] : places) {
      double base = from + line_height - 3;
      const std::vector<std::string> lines = wrapped(row->label, label_width(*row, beside, longest));
      for (const std::string& one : lines) {
        draw_.text(side / 2, base, one, row->heading ? "heading" : "");
        base += line_height;
      }
      if (row->heading || !row->draw) continue;
      const auto count = static_cast<double>(lines.size());
      const double first =
          beside ? from + std::max(0.0, line_height * count - lane * row->lanes) / 2 : from + line_height * count;
      row->draw(first + lane / 2);
    }
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
  static double label_width(const Row& row, bool beside, double longest) {
    return beside && !row.heading ? longest + 1 : width - side;
  }
};

/// A factor between values from which a linear axis hides the small ones.
constexpr double wide_range = 100;

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
    return rows(std::move(all), std::move(values), {}, spans(with_lines, wide_range));
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
      all.push_back({pair, false, static_cast<double>(marks.size()), [this, names, marks = std::move(marks)](double y) {
                       std::string way;
                       double at = y;
                       for (const auto& [level, mark] : marks) {
                         if (mark.value)
                           way += fmt::format("{}{:.2f} {:.2f}", way.empty() ? "M" : "L", axis_->at(*mark.value), at);
                         at += lane;
                       }
                       if (!way.empty()) draw_.path(way, "joins");
                       for (const auto& [level, mark] : marks) {
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
      all.push_back({name, false, 1.3, [this, names, parts = std::move(parts)](double y) {
                       double from = 0;
                       for (const auto& [part, value] : parts) {
                         draw_.box(axis_->at(from), y - lane / 2, axis_->at(from + value) - axis_->at(from), lane,
                                   fmt::format("part s{}", part % colours),
                                   fmt::format("{}: {} {}", names[part], number_text(value, 3), unit_));
                         from += value;
                       }
                       if (parts.empty()) draw_.text(axis_->at(0) + gap, y + 4, "no value", "none");
                     }});
    }
    if (all.empty()) return "";
    return rows(std::move(all), std::move(values), names, false, true);
  }
};

/// Values upwards, over a horizontal axis.
class PlaneFigure : public AskFigure {
 public:
  using AskFigure::AskFigure;

 protected:
  struct Point {
    double x = 0;
    Mark mark;
  };
  struct Series {
    std::string name;
    std::vector<Point> points;
    std::optional<double> floor = {};
  };

  std::string plane(const std::vector<Series>& all, const std::vector<std::pair<double, double>>& between,
                    const std::string& across, const std::string& upwards, bool log_x, bool log_y) {
    std::vector<double> xs, ys = at_;
    std::vector<std::string> names;
    for (const Series& one : all) {
      names.push_back(one.name);
      for (const Point& point : one.points) {
        xs.push_back(point.x);
        point.mark.add_to(ys);
      }
      if (one.floor) ys.push_back(*one.floor);
    }
    for (const auto& [low, high] : between) xs.insert(xs.end(), {low, high});
    if (xs.empty() || ys.empty()) return "";
    double top = legend(names, 0);
    for (const std::string& one : wrapped(upwards + (log_y ? ", logarithmic" : ""), width - 2 * side)) {
      top += line_height;
      draw_.text(side / 2, top, one, "title");
    }
    top += gap + 4;
    constexpr double high = 210;
    const double bottom = top + high;
    const FigureAxis y(ys, log_y, bottom, top, most_ticks);
    double longest = 0;
    for (const auto& [value, words] : y.ticks()) longest = std::max(longest, width_of(words));
    // Series stand side by side where they have the same place: from all to each its own.
    const bool intervals = std::any_of(all.begin(), all.end(), [](const Series& one) {
      return std::any_of(one.points.begin(), one.points.end(),
                         [](const Point& point) { return point.mark.low.has_value(); });
    });
    const double apart = all.size() < 2 || !intervals ? 0 : std::min(5.0, 24.0 / static_cast<double>(all.size() - 1));
    const double aside = apart * static_cast<double>(all.size() - 1) / 2 + dot + 2;
    const FigureAxis x(xs, log_x, longest + 2 * gap + aside, width - side - aside, most_ticks);
    for (const auto& [from, to] : between) draw_.box(x.at(from), top, x.at(to) - x.at(from), high, "between");
    for (const auto& [value, words] : y.ticks()) {
      draw_.line(longest + gap, y.at(value), width, y.at(value), "grid");
      draw_.text(longest + 2, y.at(value) + 4, words, "tick", "end");
    }
    ticks(x, top, bottom);
    place_lines(y, longest + gap);
    for (std::size_t k = 0; k < all.size(); ++k)
      draw(all[k], k, apart * (static_cast<double>(k) - static_cast<double>(all.size() - 1) / 2), x, y);
    return draw_.svg(title(across, bottom + line_height, log_x), upwards);
  }

 private:
  /// Lines across at values, each labelled at its right end, below the line where one above is near.
  void place_lines(const FigureAxis& y, double from) {
    double last = INFINITY;
    for (const double value : at_) {
      const double place = y.at(value);
      draw_.line(from, place, width, place, "at");
      const std::string words = number_text(value, 4) + (unit_.empty() ? "" : " " + unit_);
      const double base = std::min(place - 3, last - line_height);
      draw_.text(width - side / 2, base, words, "at", "end");
      last = base;
    }
  }
  void draw(const Series& one, std::size_t k, double aside, const FigureAxis& x, const FigureAxis& y) {
    std::string way;
    for (const Point& point : one.points)
      if (point.mark.value)
        way += fmt::format("{}{:.2f} {:.2f}", way.empty() ? "M" : "L", x.at(point.x) + aside, y.at(*point.mark.value));
    if (!way.empty()) draw_.path(way, fmt::format("way s{}", k % colours));
    if (one.floor && !one.points.empty()) {
      const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
      const auto [from, to] = std::minmax_element(one.points.begin(), one.points.end(), by_x);
      draw_.line(x.at(from->x) - dot, y.at(*one.floor), x.at(to->x) + dot, y.at(*one.floor),
                 fmt::format("floor s{}", k % colours));
    }
    for (const Point& point : one.points) {
      if (point.mark.low) draw_.whisker(y.at(*point.mark.low), y.at(*point.mark.high), x.at(point.x) + aside, true, k);
      if (point.mark.value)
        draw_.sign(x.at(point.x) + aside, y.at(*point.mark.value), k,
                   words_of(one.name, point.mark, unit_) + fmt::format(", at {}", number_text(point.x)));
    }
  }
};

class Along : public PlaneFigure {
 public:
  using PlaneFigure::PlaneFigure;
  std::string svg() override {
    InOrderMet<std::string, Series> met;
    std::vector<double> xs;
    for (const Json& row : list_of(figure_, "rows")) {
      const std::string name = text_of(row, "series");
      Series& one = met[name];
      one.name = name;
      const auto x = number_of(row, "x");
      if (!x) continue;
      one.points.push_back({*x, Mark(row)});
      xs.push_back(*x);
    }
    std::vector<Series> all;
    for (auto& [name, one] : std::move(met).list()) {
      std::stable_sort(one.points.begin(), one.points.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
      all.push_back(std::move(one));
    }
    std::vector<std::pair<double, double>> between;
    for (const Json& one : list_of(figure_, "between"))
      if (one.is_array() && one.size() == 2) {
        const std::pair range(one[0].get<double>(), one[1].get<double>());
        if (std::find(between.begin(), between.end(), range) == between.end()) between.push_back(range);
      }
    return plane(all, between, with_unit({text_of(figure_, "along"), shown_unit(text_of(figure_, "along_unit"))}),
                 value_title(), spans(xs, wide_range), false);
  }
};

class Curves : public PlaneFigure {
 public:
  using PlaneFigure::PlaneFigure;
  std::string svg() override {
    const bool logarithms = figure_.value("log", false);
    std::vector<Series> all;
    for (const Json& one : list_of(figure_, "series")) {
      Series series{text_of(one, "name"), {}, number_of(one, "floor")};
      for (const Json& point : list_of(one, "points")) {
        if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) continue;
        const double x = point[0].get<double>(), y = point[1].get<double>();
        // Zero has no logarithm.
        if (!std::isfinite(x) || !std::isfinite(y) || (logarithms && (x <= 0 || y <= 0))) continue;
        series.points.push_back({x, Mark(Json{{"value", y}})});
      }
      if (logarithms && series.floor && *series.floor <= 0) series.floor.reset();
      std::stable_sort(series.points.begin(), series.points.end(),
                       [](const Point& a, const Point& b) { return a.x < b.x; });
      all.push_back(std::move(series));
    }
    if (logarithms) std::erase_if(at_, [](double value) { return value <= 0; });
    const std::string x = text_of(figure_, "x"), y = text_of(figure_, "y");
    return plane(all, {}, x, y.empty() ? value_title() : y, logarithms, logarithms);
  }
};

}  // namespace

static std::string svg_of(const Json& figure) {
  if (!figure.is_object()) return "";
  const std::string form = text_of(figure, "form");
  if (form == "bars") return Bars(figure).svg();
  if (form == "pairs") return Pairs(figure).svg();
  if (form == "parts") return Parts(figure).svg();
  if (form == "along") return Along(figure).svg();
  if (form == "curves") return Curves(figure).svg();
  return "";
}

}  // namespace ricochet::report::ask_figures

namespace ricochet::report {

std::string figure_svg(const nlohmann::ordered_json& figure) {
  return ask_figures::svg_of(figure);
}

}  // namespace ricochet::report
