#include <fmt/format.h>

#include <algorithm>

#include "runners/report/html.hpp"
#include "runners/report/sketch_pieces.hpp"

namespace ricochet::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_named = 8, most_spans = 8;
constexpr int shown_digits = 4;

std::vector<Json> objects_at(const SceneValues& scene, const std::string& pointer) {
  const Json* found = scene.at(pointer);
  return found && found->is_array() ? found->get<std::vector<Json>>() : std::vector<Json>();
}

double number_of(const Json& object, const char* key) {
  return number_at(object, key).value_or(0);
}

std::string ground_mark(double x, double y) {
  std::string hatch;
  for (double u = -10; u <= 10; u += 5) hatch += fmt::format("M{:.1f} {:.1f}l-4 5", x + u, y);
  return line(x - 12, y, x + 12, y, "solid") + path(hatch, "hatch");
}

std::string clamp_mark(double x, double y, double side) {
  if (side != 0) return wall(x, y - 30, y + 30, side);
  // Between the ends it lets the beam pass.
  return ground_mark(x, y + 7) + line(x - 12, y - 7, x + 12, y - 7, "solid") +
         line(x - 12, y - 7, x - 12, y - 3, "solid") + line(x + 12, y - 7, x + 12, y - 3, "solid");
}

std::string pin_mark(double x, double y) {
  return path(fmt::format("M{:.1f} {:.1f}l-9 15h18z", x, y + 1), "solid pin") + ground_mark(x, y + 16);
}

// Two plates with rollers: the slope is held, the height is free.
std::string slide_mark(double x, double y, double side) {
  const double out = side == 0 ? 0 : side * 9;
  std::string marks = line(x, y - 14, x, y + 14, "solid");
  for (const double v : {-8.0, 8.0})
    marks += fmt::format("<circle class=\"solid\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>", x + out / 2, y + v);
  return marks + (side == 0 ? "" : wall(x + out, y - 22, y + 22, side));
}

std::string spring_mark(double x, double y, bool spring, bool rotation) {
  std::string marks;
  if (spring) {
    std::string zigzag = fmt::format("M{:.1f} {:.1f}v4", x, y);
    for (int k = 0; k < 3; ++k) zigzag += "l6 1.5l-12 3l6 1.5";
    marks += path(zigzag + "v4", "spring") + ground_mark(x, y + 26);
  }
  if (rotation) marks += path(fmt::format("M{:.1f} {:.1f}a11 11 0 1 1 14 6", x - 11, y - 3), "spring");
  return marks;
}

std::string mark_of(const Json& support, double x, double y, double side) {
  const auto type = support.value("type", "");
  if (type == "clamped") return clamp_mark(x, y, side);
  if (type == "pinned") return pin_mark(x, y);
  if (type == "sliding") return slide_mark(x, y, side);
  return spring_mark(x, y, number_of(support, "stiffness") > 0, number_of(support, "rotation") > 0);
}

}  // namespace

HeldBeam held_beam(const SceneValues& scene, double length, const BeamFrame& frame, Labels& label) {
  HeldBeam out;
  const auto x_of = [&](double x) { return frame.left + frame.span * std::clamp(x / length, 0.0, 1.0); };
  const std::vector<Json> supports = objects_at(scene, "/scene/structure/supports");
  out.given = scene.at("/scene/structure/supports") != nullptr;
  std::vector<double> places = {0, length};
  for (const Json& support : supports) {
    const double place = number_of(support, "x"), x = x_of(place);
    const double side = place <= 0 ? -1 : place >= length ? 1 : 0;
    out.svg += mark_of(support, x, frame.rest, side);
    const bool spring = number_of(support, "stiffness") > 0;
    if (supports.size() <= most_named)
      out.svg += spring     ? label(x + 14, frame.rest + 22, support.value("name", ""), "start", 1)
                 : side < 0 ? label(x + 4, frame.rest + 44, support.value("name", ""), "start", 1)
                            : label(x, frame.rest + 44, support.value("name", ""), "middle", 1);
    places.push_back(place);
  }
  for (const Json& mass : objects_at(scene, "/scene/structure/masses")) {
    const double x = x_of(number_of(mass, "x"));
    out.masses += circle(x, frame.rest, 8, "body") +
                  label(x, frame.rest - 14, number_text(number_of(mass, "mass"), shown_digits) + " kg");
  }
  if (const auto tension = scene.number("/scene/structure/tension"); tension && *tension != 0) {
    const double near = frame.left + frame.span + 8, far = near + 34;
    out.svg += (*tension > 0 ? arrow(near, frame.rest, far, frame.rest) : arrow(far, frame.rest, near, frame.rest)) +
               label(far + 4, frame.rest + 4, "T", "start");
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  out.measured = frame.measure > 0 && out.given && places.size() > 2 && places.size() <= most_spans + 1;
  if (!out.measured) return out;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double from = x_of(places[i]), to = x_of(places[i + 1]);
    out.spans += line(to, frame.measure - 5, to, frame.measure + 5, "measure") +
                 label((from + to) / 2, frame.measure + 12, number_text(places[i + 1] - places[i], shown_digits) + " m",
                       "middle", 1);
  }
  return out;
}

}  // namespace ricochet::report
