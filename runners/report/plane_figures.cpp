#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/figure_drawing.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::report::ask_figures {
namespace {

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

  /// The axes, drawn with legend, ticks and titles.
  struct Frame {
    FigureAxis x, y;
    double left = 0, top = 0, bottom = 0, end = 0;
  };
  /// `aside`: what stands beside its place of x, to each side. `labels`: what tells the series apart.
  Frame frame(const std::vector<std::string>& labels, const std::vector<double>& xs, const std::vector<double>& ys,
              const std::string& across, const std::string& upwards, bool log_x, bool log_y, double aside) {
    // A long legend stands below.
    constexpr std::size_t most_above = 8;
    const bool above = labels.size() <= most_above;
    double top = above ? legend(labels, 0) : 0;
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
    const FigureAxis x(xs, log_x, longest + 2 * gap + aside, width - side - aside, most_ticks);
    for (const auto& [value, words] : y.ticks()) {
      draw_.line(longest + gap, y.at(value), width, y.at(value), "grid");
      draw_.text(longest + 2, y.at(value) + 4, words, "tick", "end");
    }
    ticks(x, top, bottom);
    const double end = title(across, bottom + line_height, log_x);
    return {x, y, longest + gap, top, bottom, above ? end : legend(labels, end)};
  }

  std::string plane(const std::vector<Series>& all, const std::vector<std::pair<double, double>>& between,
                    const std::string& across, const std::string& upwards, bool log_x, bool log_y) {
    std::vector<double> xs, ys = at_;
    std::vector<std::string> names;
    double widest = 0;
    for (const Series& one : all) {
      names.push_back(one.name);
      for (const Point& point : one.points) {
        xs.push_back(point.x);
        point.mark.add_to(ys);
        if (point.mark.low) widest = std::max(widest, *point.mark.high - *point.mark.low);
      }
      if (one.floor) ys.push_back(*one.floor);
    }
    for (const auto& [low, high] : between) xs.insert(xs.end(), {low, high});
    if (xs.empty() || ys.empty()) return "";
    // Whiskers stand side by side where they have the same place. Marks without a whisker to be seen stand as near to
    // theirs as lets all be seen.
    const auto others = static_cast<double>(all.size() - 1);
    const auto [lowest, highest] = std::minmax_element(ys.begin(), ys.end());
    constexpr double seen = 0.02;  // of the axis
    const bool whiskers = log_y ? widest > 0 : widest > seen * (*highest - *lowest);
    double apart = all.size() < 2 ? 0 : whiskers ? std::min(5.0, 24.0 / others) : std::min(2.0, 8.0 / others);
    // Far nearer to its own place than to the next.
    constexpr double of_places = 0.25;
    if (others > 0) apart = std::min(apart, of_places * between_places(xs, log_x) / others);
    const Frame in = frame(names, xs, ys, across, upwards, log_x, log_y, apart * others / 2 + dot + 2);
    for (const auto& [from, to] : between)
      draw_.box(in.x.at(from), in.top, in.x.at(to) - in.x.at(from), in.bottom - in.top, "between");
    place_lines(in);
    for (std::size_t k = 0; k < all.size(); ++k)
      draw(all[k], k, apart * (static_cast<double>(k) - others / 2), in.x, in.y);
    return draw_.svg(in.end, upwards, true);
  }

 private:
  /// The least distance of two places on an axis, about; infinite of one place.
  static double between_places(std::vector<double> xs, bool logarithms) {
    if (logarithms)
      for (double& x : xs) x = std::log(x);
    std::sort(xs.begin(), xs.end());
    const double whole = xs.back() - xs.front();
    constexpr double same = 1e-9, drawn = 0.8;  // of the width
    double least = INFINITY;
    for (std::size_t k = 1; k < xs.size(); ++k)
      if (const double apart = xs[k] - xs[k - 1]; apart > same * whole) least = std::min(least, apart);
    return std::isfinite(least) ? drawn * width * least / whole : INFINITY;
  }

  /// Lines across at values, each labelled at its right end, below the line where one above is near.
  void place_lines(const Frame& in) {
    double last = INFINITY;
    for (const double value : at_) {
      const double place = in.y.at(value);
      draw_.line(in.left, place, width, place, "at");
      const std::string words = label_at(value);
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
      if (series.points.empty()) continue;
      // One that lies far below all would stretch the axis.
      constexpr double far = 100;
      const auto lowest = std::min_element(series.points.begin(), series.points.end(),
                                           [](const auto& a, const auto& b) { return *a.mark.value < *b.mark.value; });
      if (logarithms && series.floor && far * *series.floor < *lowest->mark.value) series.floor.reset();
      if (series.floor) floor_ = "error floor";
      all.push_back(std::move(series));
    }
    if (logarithms) std::erase_if(at_, [](double value) { return value <= 0; });
    return plane(all, {}, axis_title("x"), axis_title("y"), logarithms, logarithms);
  }
};

/// Branches of orbits: what is not stable is broken, special points are marked by their kind.
class Branches : public PlaneFigure {
 public:
  using PlaneFigure::PlaneFigure;
  std::string svg() override {
    std::vector<double> xs, ys;
    std::vector<std::string> names, kinds;
    for (const Json& one : list_of(figure_, "series")) {
      names.push_back(text_of(one, "name"));
      for (const Json& point : list_of(one, "points"))
        if (is_point(point)) {
          xs.push_back(point[0].get<double>());
          ys.push_back(point[1].get<double>());
        }
    }
    for (const Json& mark : list_of(figure_, "marks")) {
      if (!is_mark(mark)) continue;
      const std::string kind = text_of(mark, "kind");
      if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
      xs.push_back(*number_of(mark, "value"));
      ys.push_back(*number_of(mark, "tip"));
    }
    if (xs.empty()) return "";
    std::vector<std::string> labels = names;
    labels.insert(labels.end(), kinds.begin(), kinds.end());
    lines_ = names.size();
    for (std::size_t place = 0; place < kinds.size(); ++place) signs_.push_back(series_of_kind(place));
    if (any_unstable()) floor_ = "unstable";
    const Frame in = frame(labels, xs, ys, axis_title("x"), axis_title("y"), false, false, dot + 2);
    for (std::size_t k = 0; k < names.size(); ++k)
      draw_branch(list_of(list_of(figure_, "series")[k], "points"), k, names[k], in);
    for (const Json& mark : list_of(figure_, "marks")) {
      if (!is_mark(mark)) continue;
      const std::string kind = text_of(mark, "kind");
      const double x = *number_of(mark, "value");
      const auto place = static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
      draw_.sign(in.x.at(x), in.y.at(*number_of(mark, "tip")), series_of_kind(place),
                 fmt::format("{}: {} at {}", kind, text_of(mark, "branch"), number_text(x, 5)));
    }
    return draw_.svg(in.end, axis_title("y"), true);
  }

 private:
  /// Signs of special points have one colour, which is that of no branch but the eighth, and differ in form.
  static std::size_t series_of_kind(std::size_t place) { return colours - 1 + colours * place; }
  bool any_unstable() const {
    for (const Json& one : list_of(figure_, "series"))
      for (const Json& point : list_of(one, "points"))
        if (is_point(point) && !(point.size() > 2 && point[2].is_boolean() && point[2].get<bool>())) return true;
    return false;
  }
  static bool is_point(const Json& point) {
    return point.is_array() && point.size() >= 2 && point[0].is_number() && point[1].is_number() &&
           std::isfinite(point[0].get<double>()) && std::isfinite(point[1].get<double>());
  }
  static bool is_mark(const Json& mark) { return number_of(mark, "value") && number_of(mark, "tip"); }

  /// Stretches of one stability, each as far as the first point of the next.
  void draw_branch(const Json& points, std::size_t k, const std::string& name, const Frame& in) {
    std::string way;
    bool stable = true;
    const auto end = [&] {
      if (way.find('L') != std::string::npos)
        draw_.path(way, fmt::format("branch s{}{}", k % colours, stable ? "" : " unstable"), name);
    };
    for (const Json& point : points) {
      if (!is_point(point)) continue;
      const bool is_stable = point.size() > 2 && point[2].is_boolean() && point[2].get<bool>();
      const std::string place =
          fmt::format("{:.1f} {:.1f}", in.x.at(point[0].get<double>()), in.y.at(point[1].get<double>()));
      if (way.empty()) stable = is_stable;
      way += (way.empty() ? "M" : "L") + place;
      if (is_stable == stable) continue;
      end();
      way = "M" + place;
      stable = is_stable;
    }
    end();
  }
};

}  // namespace

std::string plane_figure(const std::string& form, const Json& figure) {
  if (form == "along") return Along(figure).svg();
  if (form == "curves") return Curves(figure).svg();
  return form == "branches" ? Branches(figure).svg() : "";
}

}  // namespace ricochet::report::ask_figures
