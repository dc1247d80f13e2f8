#include "runners/report/scene_sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "runners/report/html.hpp"
#include "runners/report/sketch_pieces.hpp"
#include "runners/study/body_keys.hpp"

namespace ricochet::report {
namespace {

using Json = nlohmann::ordered_json;

// Pixels of the drawing: where a structure begins, how long it is, and how far stops may lie off.
constexpr double sketch_width = 640, sketch_height = 184, sketch_left = 76, sketch_span = 480, together_span = 420,
                 nearest_gap = 9, widest_gap = 44, tallest_nodes = 230, least_span = 36, points_span = 140,
                 row_half = 62, damper_length = 44, narrow_letters = 21, wide_letters = 12;  // as page.css has them
constexpr std::size_t most_labelled = 12, most_unnamed = 4;

/// Pixels between rest and a stop: gaps are to scale among each other, none so small that it does not show.
class Gaps {
 public:
  explicit Gaps(const std::vector<SceneValues::Stop>& stops) {
    for (const SceneValues::Stop& stop : stops)
      for (const auto& gap : {stop.lower, stop.upper, stop.radius})
        if (gap && std::isfinite(*gap)) largest_ = std::max(largest_, std::abs(*gap));
  }
  double operator()(double gap) const {
    return largest_ == 0 || gap == 0
               ? 4
               : nearest_gap + (widest_gap - nearest_gap) * std::min(1.0, std::abs(gap) / largest_);
  }

 private:
  double largest_ = 0;
};

// What moves what holds a structure, where something does.
std::string support_words(const SceneValues& scene) {
  const auto* motions = scene.at("/scene/motions");
  const auto* supports = scene.at("/scene/structure/supports");
  const auto moves = [&](const Json& motion) {
    const Json named = motion.value("supports", Json());
    if (!supports || !supports->is_array() || !named.is_array()) return true;
    return std::any_of(named.begin(), named.end(), [&](const Json& name) {
      return name == "all" || std::any_of(supports->begin(), supports->end(),
                                          [&](const Json& one) { return one.value("name", Json()) == name; });
    });
  };
  if (motions && motions->is_array())
    for (const Json& motion : *motions)
      if (moves(motion)) return motion.contains("acceleration") ? "a(t)" : "φ(t)";
  return scene.text("/scene/support/amplitude", "m").empty() ? "" : "A₀ sin(ωt)";
}

// What pushes: forces at places, and bodies that are pushed along their length.
struct Loads {
  std::vector<Json> forces;         ///< places
  std::vector<std::size_t> number;  ///< of each among those that have a place
  std::vector<std::string> along;   ///< bodies

  bool on(const std::string& body) const { return std::find(along.begin(), along.end(), body) != along.end(); }
};

Loads loads_of(const SceneValues& scene) {
  Loads out;
  const Json* load = scene.at("/scene/load");
  if (!load) return out;
  if (!load->is_array()) {
    if (load->is_string() ? load->get<std::string>() != "0" : first_number(load).value_or(0) != 0) out.along = {""};
    return out;
  }
  std::size_t placed = 0;
  for (const Json& term : *load) {
    const Json at = term.is_object() ? term.value("at", Json()) : Json();
    if (!term.is_object() || !term.contains("force")) {
      out.along.push_back(term.is_object() ? term.value("body", "") : "");
    } else if (at.is_object()) {
      out.forces.push_back(at);
      out.number.push_back(placed++);
    } else {
      out.forces.push_back(first_number(&at) ? Json{{"x", *first_number(&at)}} : Json::object());
      out.number.push_back(std::string::npos);
    }
  }
  return out;
}

class SceneDrawing {
 public:
  SceneDrawing(const Json& study, bool narrow)
      : scene_(study),
        bodies_(scene_.bodies()),
        loads_(loads_of(scene_)),
        layout_(scene_.at("/files/layout")),
        narrow_(narrow),
        label_(narrow ? narrow_letters : wide_letters, sketch_width) {
    for (const auto& [name, body] : bodies_) {
      const Json* layout = bodies_.size() == 1 ? layout_ : body.at("/files/layout/bodies/" + name);
      layouts_.push_back(layout);
      sizes_.push_back(piece_size(body, layout));
    }
    stops_ = bodies_.front().second.stops(bodies_.front().second.number("/scene/structure/length").value_or(1));
  }

  std::string svg(const std::string& said) {
    for (const PieceFrame& frame : bodies_.size() == 1 ? alone() : together()) {
      const std::size_t b = pieces_.size();
      const auto piece = draw_piece(bodies_[b].second, layouts_[b], frame, places_of(b), label_);
      pieces_.push_back(piece.value_or(Piece{"", [](const Json&) { return std::nullopt; }}));
      strokes_ += pieces_.back().svg;
    }
    if (strokes_.empty()) return "";
    for (std::size_t i = 0; i < stops_.size(); ++i) draw_stop(i);
    for (std::size_t k = 0; k < loads_.forces.size(); ++k) draw_force(k);
    const auto [from, to] = label_.reach(0, height_);
    return fmt::format(
        "<svg class=\"sketch{}\" viewBox=\"0 {:.0f} {} {:.0f}\" role=\"img\" aria-label=\"{}\">{}</svg>\n",
        narrow_ ? " narrow" : "", from, sketch_width, to - from, escape(said), strokes_);
  }

 private:
  std::size_t body_of(const Json& place) const {
    const std::string name = place.value("body", "");
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].first == name) return b;
    return bodies_.size() == 1 ? 0 : bodies_.size();
  }
  std::vector<Json> places_of(std::size_t body) const {
    std::vector<Json> out;
    const auto add = [&](const Json& place) {
      if (place.is_object() && body_of(place) == body) out.push_back(place);
    };
    for (const SceneValues::Stop& stop : stops_) {
      add(stop.at);
      add(stop.to);
    }
    if (!sizes_[body].along)
      for (const Json& place : loads_.forces) add(place);
    return out;
  }

  std::vector<PieceFrame> alone() {
    const PieceSize& size = sizes_.front();
    const auto& [name, body] = bodies_.front();
    const std::string type = body.word("/scene/structure/type");
    PieceFrame frame{sketch_left, sketch_span, 84};
    frame.shaken = support_words(body);
    frame.loaded = loads_.on("") || loads_.on(name);
    height_ = sketch_height;
    if (type == "beam") frame.measure = height_ - 14;
    if (type == "oscillator") frame.rest = 128;
    if (type == "bar") frame = {136, 360, 144, 1, 0, {1, 0}, true, true, frame.loaded, {}, {}};
    if (!layouts_.front()) return {frame};
    constexpr double margin = 122;
    frame.left = margin;
    frame.span = sketch_width - 2 * margin;
    if (!(size.length > 0 || size.tall > 0)) return {frame};
    frame.scale =
        std::min(size.length > 0 ? frame.span / size.length : 1e300, size.tall > 0 ? tallest_nodes / size.tall : 1e300);
    frame.left += (frame.span - frame.scale * size.length) / 2;
    frame.span = frame.scale * size.length;
    height_ = 2 * row_half + std::max(60.0, frame.scale * size.tall);
    frame.rest = height_ / 2;
    frame.measure = height_ - 12;
    return {frame};
  }

  // x of a place of its own body, m.
  double x_of(const Json& place, const Json& drawn, const char* key, std::size_t body) const {
    if (sizes_[body].along) return 0;
    if (const auto x = number_at(place, "x")) return *x;
    const auto node = number_at(drawn, key);
    const Json* layout = layouts_[body];
    if (node && *node >= 0 && layout && layout->contains("x"))
      return layout->at("x").at(static_cast<std::size_t>(*node));
    return sizes_[body].first + sizes_[body].length / 2;
  }
  Json drawn_stop(std::size_t i) const {
    return layout_ && layout_->contains("stops") && i < layout_->at("stops").size() ? layout_->at("stops")[i] : Json();
  }

  std::vector<PieceFrame> together() {
    std::vector<BodyShape> shapes;
    for (const PieceSize& size : sizes_) shapes.push_back({size.first, size.length, size.along});
    std::vector<BodyMeeting> meetings;
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      const SceneValues::Stop& stop = stops_[i];
      const std::size_t at = body_of(stop.at), to = stop.to.is_object() ? body_of(stop.to) : at;
      if (at == to || std::max(at, to) >= bodies_.size()) continue;
      const Json drawn = drawn_stop(i);
      meetings.push_back(
          {at, to, x_of(stop.at, drawn, "at", at), x_of(stop.to, drawn, "to", to), stop.upper || !stop.lower});
    }
    const std::vector<BodyPlace> places = body_places(shapes, meetings);
    const bool columns = all_along(shapes);
    int rows = 0;
    double left = 1e300, right = -1e300, tallest = 0;
    for (std::size_t b = 0; b < sizes_.size(); ++b) {
      rows = std::max(rows, places[b].row + 1);
      left = std::min(left, sizes_[b].first + places[b].shift);
      right = std::max(right, sizes_[b].first + places[b].shift + sizes_[b].length);
      tallest = std::max(tallest, sizes_[b].tall);
    }
    double scale = right > left ? together_span / (right - left) : 1;
    if (tallest > 0) scale = std::min(scale, tallest_nodes / tallest);
    std::vector<double> half(static_cast<std::size_t>(rows), row_half), middle = half;
    for (std::size_t b = 0; b < sizes_.size(); ++b) {
      double& one = half[static_cast<std::size_t>(places[b].row)];
      one = std::max(one, row_half + scale * sizes_[b].tall / 2);
    }
    height_ = columns ? sketch_height : 0;
    for (auto row = half.size(); !columns && row-- > 0; height_ += half[row]) middle[row] = height_ += half[row];
    std::vector<PieceFrame> out;
    for (std::size_t b = 0; b < sizes_.size(); ++b) {
      const SceneValues& body = bodies_[b].second;
      const std::string type = body.word("/scene/structure/type");
      const auto row = static_cast<std::size_t>(places[b].row);
      // What moves along its axis has its wall away from what it meets.
      bool away = false;
      for (auto one = meetings.rbegin(); one != meetings.rend(); ++one)
        if (one->at == b || one->to == b) away = places[one->at == b ? one->to : one->at].row < places[b].row;
      away = away && type == "oscillator";
      PieceFrame frame;
      frame.alone = false;
      frame.scale = scale;
      frame.name = bodies_[b].first;
      frame.shaken = support_words(body);
      frame.loaded = loads_.on(frame.name);
      frame.forward = !away;
      const double along = sizes_[b].length * scale, from = sizes_[b].first + places[b].shift - left;
      frame.span = std::max(layouts_[b] && along == 0 ? points_span : least_span, along);
      frame.left = sketch_left + (together_span - scale * (right - left)) / 2 + from * scale - (frame.span - along) / 2;
      frame.rest = middle[row];
      if (columns) {
        constexpr double apart = 60, room = 560;
        frame.span = (room - apart * (rows - 1)) / rows;
        frame.left = 40 + static_cast<double>(row) * (frame.span + apart) + (away ? frame.span : 0);
        frame.axis = {away ? -1.0 : 1.0, 0};
        frame.rest = 128;
      } else if (sizes_[b].along) {
        frame.span = 100;
        frame.left = sketch_left + (from + (right > left ? 0 : 0.5)) * scale;
        frame.axis = {0, away ? 1.0 : -1.0};
        frame.rest = middle[row] + (away ? -50 : 50);
      }
      out.push_back(std::move(frame));
    }
    return out;
  }

  // Where the place of a stop or a load is; `drawn` stands for it where a layout has it.
  std::optional<Spot> spot_of(const Json& place, const Json& drawn, const char* key) const {
    const std::size_t body = place.is_object() ? body_of(place) : pieces_.size();
    if (body >= pieces_.size()) return std::nullopt;
    const bool known = drawn.is_object() && drawn.contains(key) && layouts_[body] && layouts_[body]->contains("nodes");
    return pieces_[body].spot(known ? Json{{"at", drawn[key]}, {"direction", drawn["direction"]}} : place);
  }

  // Beside a mark on the side where it points.
  std::string beside(double x, double y, double dx, double dy, const std::string& text) {
    const bool across = std::abs(dx) > 0.5 * std::abs(dy);
    const double low = across ? 4 + 12 * dy : dy > 0 ? 22 : -12;
    return label_(x + 12 * dx, y + low, text, !across ? "middle" : dx > 0 ? "start" : "end", dy > 0 ? 1 : -1);
  }

  // A plate between two that press it, on the ground or on a rod to the other place.
  void draw_damper(const Spot& at, double dx, double dy, bool on_rod) {
    const auto point = [&](double along, double across) {
      return std::pair(at.x + along * dx - across * dy, at.y + along * dy + across * dx);
    };
    const auto stroke = [&](std::pair<double, double> from, std::pair<double, double> to) {
      strokes_ += line(from.first, from.second, to.first, to.second, "stop");
    };
    constexpr double begins = 16, ends = 34, wide = 5;
    stroke(point(0, 0), point(ends - 4, 0));
    for (const double side : {-wide, wide}) stroke(point(begins, side), point(ends, side));
    stroke(point(ends, -wide), point(ends, wide));
    stroke(point(ends, 0), point(damper_length, 0));
    if (!on_rod) {
      const auto [x, y] = point(damper_length, 0);
      strokes_ += face(x, y, dx, dy);
    }
  }

  void draw_stop(std::size_t i) {
    const SceneValues::Stop& stop = stops_[i];
    const Json drawn = drawn_stop(i);
    const std::optional<Spot> at = spot_of(stop.at, drawn, "at"), to = spot_of(stop.to, drawn, "to");
    if (!at) return;
    const Gaps gaps(stops_);
    const bool named =
        stop.name.empty() ? stops_.size() <= most_unnamed || i + 1 == stops_.size() : stops_.size() <= most_labelled;
    std::string name = stop.name.empty() || !named ? "" : stop.name + " ";
    if (to) strokes_ += circle(to->x, to->y, 4, "stop");
    const auto join = [&](double x, double y) {  // to the other place of the stop, round what lies between
      if (!to) return;
      const bool flat = std::abs(to->dx * (to->x - x) + to->dy * (to->y - y)) < 0.5 * std::abs(to->x - x);
      const double bow = flat ? 36 : 0;
      strokes_ += path(fmt::format("M{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}", x, y, (x + to->x) / 2 + bow * at->dx,
                                   (y + to->y) / 2 + bow * at->dy, to->x, to->y),
                       "stop link");
    };
    if (stop.radius) {
      const double r = gaps(*stop.radius);
      std::string d;
      for (int k = 0; k < 48; ++k) {
        const double c = r * std::cos(M_PI * k / 24), s = r * std::sin(M_PI * k / 24);
        d += fmt::format("{}{:.1f} {:.1f}", k ? "L" : "M", at->x + c * at->ring[0] + s * at->ring[2],
                         at->y + c * at->ring[1] + s * at->ring[3]);
      }
      strokes_ += path(d + "z", "stop") + label_(at->x, at->y - r - 10, name + "radius " + metres(*stop.radius));
      join(at->x, at->y - r);
      return;
    }
    constexpr double leaves = 0.2;
    const double size = std::hypot(at->dx, at->dy);
    if (size < leaves) {  // along the line of sight
      strokes_ += circle(at->x, at->y, 9, "stop") + (named ? beside(at->x, at->y, 1, -1, stop.name) : "");
      return;
    }
    const double dx = at->dx / size, dy = at->dy / size;
    if (stop.pressed) {
      draw_damper(*at, dx, dy, to.has_value());
      join(at->x + damper_length * dx, at->y + damper_length * dy);
      if (named) strokes_ += beside(at->x + damper_length * dx, at->y + damper_length * dy, dx, dy, stop.name);
      return;
    }
    for (const auto& [side, value, more] :
         {std::tuple(1.0, stop.upper, at->front), std::tuple(-1.0, stop.lower, at->back)}) {
      if (!value) continue;
      const double far = side * (gaps(*value) + more), x = at->x + far * dx, y = at->y + far * dy;
      strokes_ += face(x, y, side * dx, side * dy);
      join(x + 6 * side * dx, y + 6 * side * dy);
      if (!named) continue;
      const bool across = std::abs(dx) > std::abs(dy);
      strokes_ += to ? label_(across ? x : x + 16, across ? y - 18 : y - 4, name + metres(*value),
                              across ? "middle" : "start", side * dy > 0 ? 1 : -1)
                     : beside(x, y, side * dx, side * dy, name + metres(*value));
      name.clear();
    }
  }

  void draw_force(std::size_t k) {
    const Json drawn = layout_ && layout_->contains("loads") && loads_.number[k] < layout_->at("loads").size()
                           ? layout_->at("loads")[loads_.number[k]]
                           : Json();
    const std::optional<Spot> at = spot_of(loads_.forces[k], drawn, "at");
    if (!at) return;
    const double size = std::hypot(at->dx, at->dy), dx = size > 0 ? at->dx / size : 0,
                 dy = size > 0 ? at->dy / size : 0;
    const std::string here = fmt::format("{:.1f} {:.1f} {:.2f} {:.2f}", at->x, at->y, dx, dy);
    if (std::find(pushed_.begin(), pushed_.end(), here) != pushed_.end()) return;
    pushed_.push_back(here);
    constexpr double near = 6, far = 34;
    if (size == 0) {
      strokes_ += label_(at->x, at->y - 10, "F(t)");
      return;
    }
    const double x = at->x - (far + at->back) * dx, y = at->y - (far + at->back) * dy;
    strokes_ += arrow(x, y, at->x - (near + at->back) * dx, at->y - (near + at->back) * dy) +
                (std::abs(dx) > std::abs(dy) ? beside(x, y, -dx, -dy, "F(t)") : label_(x + 7, y + 4, "F(t)", "start"));
  }

  SceneValues scene_;
  std::vector<std::pair<std::string, SceneValues>> bodies_;
  Loads loads_;
  const Json* layout_;
  std::vector<const Json*> layouts_;
  std::vector<PieceSize> sizes_;
  std::vector<SceneValues::Stop> stops_;
  std::vector<Piece> pieces_;
  std::vector<std::string> pushed_;
  std::string strokes_;
  bool narrow_;
  Labels label_;
  double height_ = 0;
};

}  // namespace

std::string scene_svg(const nlohmann::ordered_json& study, bool narrow) {
  return SceneDrawing(study, narrow).svg("Sketch of the scene: " + in_a_line(scene_numbers(study)));
}

}  // namespace ricochet::report
