// Figures of asks, read back from their SVG: all is within the drawing, every row has its name, every value its place.
#include "runners/report/ask_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>

#include "runners/report/figure_axis.hpp"
#include "runners/table/text.hpp"

using namespace ricochet;
using namespace ricochet::report;

namespace ask_figure_tests {
namespace {

using Json = nlohmann::ordered_json;

struct Words {
  double left, right, base;
  std::string text, classes;
};
struct Line {
  double x1, y1, x2, y2;
  std::string classes;
};

/// What is drawn; places in units of the drawing.
struct Drawn {
  double width = 0, height = 0;
  std::vector<Words> words;
  std::vector<Line> lines;
  std::vector<Line> whiskers;                   ///< from low to high
  std::vector<std::pair<double, double>> dots;  ///< centres, of circles alone where signs differ
  std::vector<Line> boxes;                      ///< corners
};

// Matches look into the text, which must outlive them.
std::vector<std::smatch> all_of(std::string&& text, const char* pattern) = delete;
std::vector<std::smatch> all_of(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::vector<std::smatch> out;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) out.push_back(*at);
  return out;
}

// As wide as a letter of a wide sans-serif font is on average.
constexpr double letter = 12, glyph = 0.6 * letter;

Drawn read(const std::string& svg) {
  Drawn out;
  const auto box = all_of(svg, R"(viewBox="0 0 ([0-9.]+) ([0-9.]+)\")");
  REQUIRE(box.size() == 1);
  out.width = std::stod(box[0][1]);
  out.height = std::stod(box[0][2]);
  for (const auto& one :
       all_of(svg,
              R"re(<text x="([^"]+)" y="([^"]+)"(?: text-anchor="([^"]+)")?(?: class="([^"]+)")?>([^<]*)</text>)re")) {
    const double wide = glyph * static_cast<double>(shown_width(one[5])), x = std::stod(one[1]);
    const double left = one[3] == "middle" ? x - wide / 2 : one[3] == "end" ? x - wide : x;
    out.words.push_back({left, left + wide, std::stod(one[2]), one[5], one[4]});
  }
  for (const auto& one :
       all_of(svg, R"re(<line x1="([^"]+)" y1="([^"]+)" x2="([^"]+)" y2="([^"]+)" class="([^"]+)"/>)re"))
    out.lines.push_back({std::stod(one[1]), std::stod(one[2]), std::stod(one[3]), std::stod(one[4]), one[5]});
  for (const auto& one :
       all_of(svg, R"re(<path d="M([^ ]+) ([^HVM"]+)([HV])([^M"]+)M[^"]*" class="(whisker[^"]*)")re")) {
    const double x = std::stod(one[1]), y = std::stod(one[2]), to = std::stod(one[4]);
    out.whiskers.push_back(one[3] == "H" ? Line{x, y, to, y, one[5]} : Line{x, y, x, to, one[5]});
  }
  for (const auto& one : all_of(svg, R"re(<circle cx="([^"]+)" cy="([^"]+)")re"))
    out.dots.emplace_back(std::stod(one[1]), std::stod(one[2]));
  for (const auto& one :
       all_of(svg, R"re(<rect x="([^"]+)" y="([^"]+)" width="([^"]+)" height="([^"]+)" class="([^"]+)")re")) {
    const double x = std::stod(one[1]), y = std::stod(one[2]);
    out.boxes.push_back({x, y, x + std::stod(one[3]), y + std::stod(one[4]), one[5]});
  }
  CHECK(all_of(svg, "<text").size() == out.words.size());
  CHECK(all_of(svg, "<line").size() == out.lines.size());
  CHECK(all_of(svg, "class=\"whisker").size() == out.whiskers.size());
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  return out;
}

void check_within(const Drawn& drawn) {
  // Places are written with two decimals.
  constexpr double rounding = 0.011;
  const auto inside = [&](double x, double y) {
    return x >= -rounding && x <= drawn.width + rounding && y >= -rounding && y <= drawn.height + rounding;
  };
  for (const Words& one : drawn.words) {
    INFO(one.text << " from " << one.left << " to " << one.right << " at " << one.base);
    CHECK((inside(one.left, one.base) && inside(one.right, one.base)));
  }
  for (const auto& list : {drawn.lines, drawn.whiskers, drawn.boxes})
    for (const Line& one : list) {
      INFO(one.classes << " " << one.x1 << " " << one.y1 << " " << one.x2 << " " << one.y2);
      CHECK((inside(one.x1, one.y1) && inside(one.x2, one.y2)));
    }
  for (const auto& [x, y] : drawn.dots) CHECK(inside(x, y));
}

void check_apart(const Drawn& drawn) {
  constexpr double above = 8, below = 2;  // a letter's height over its base line, and what hangs beneath
  for (std::size_t a = 0; a < drawn.words.size(); ++a)
    for (std::size_t b = a + 1; b < drawn.words.size(); ++b) {
      const Words &one = drawn.words[a], &other = drawn.words[b];
      const bool across = one.left < other.right && other.left < one.right,
                 upright = one.base - above < other.base + below && other.base - above < one.base + below;
      INFO(one.text << " and " << other.text);
      CHECK_FALSE((across && upright));
    }
}

/// All words without blanks: labels are broken at these, or within a long word.
std::string joined(const Drawn& drawn) {
  std::string out;
  for (const Words& one : drawn.words) out += one.text + '\n';
  out.erase(std::remove_if(out.begin(), out.end(), [](char c) { return c == ' ' || c == '\n'; }), out.end());
  return out;
}
void check_named(const Drawn& drawn, std::string name) {
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  INFO(name);
  CHECK(joined(drawn).find(name) != std::string::npos);
}

double number_of(std::string text) {
  if (text.starts_with("−")) text.replace(0, std::string("−").size(), "-");
  return std::stod(text);
}

/// The scale that the ticks tell, of places x, or y where upright.
struct Told {
  double value1, place1, value2, place2;
  bool logarithms;
  double at(double value) const {
    const double share =
        logarithms ? std::log(value / value1) / std::log(value2 / value1) : (value - value1) / (value2 - value1);
    return place1 + share * (place2 - place1);
  }
};
std::optional<Told> told(const Drawn& drawn, bool upright, bool logarithms) {
  std::vector<std::pair<double, double>> ticks;
  for (const Line& line : drawn.lines) {
    if (line.classes != "grid" || (upright ? line.y1 != line.y2 : line.x1 != line.x2)) continue;
    for (const Words& one : drawn.words)
      if (one.classes == "tick" &&
          (upright ? std::abs(one.base - 4 - line.y1) < 0.02 : std::abs((one.left + one.right) / 2 - line.x1) < 0.02)) {
        ticks.emplace_back(number_of(one.text), upright ? line.y1 : line.x1);
        break;
      }
  }
  if (ticks.size() < 2) return std::nullopt;
  std::sort(ticks.begin(), ticks.end());
  return Told{ticks.front().first, ticks.front().second, ticks.back().first, ticks.back().second, logarithms};
}
bool in_logarithms(const Drawn& drawn) {
  return std::any_of(drawn.words.begin(), drawn.words.end(),
                     [](const Words& one) { return one.text.find("logarithmic") != std::string::npos; });
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  int whole(int low, int high) { return std::uniform_int_distribution(low, high)(engine_); }
  bool coin() { return whole(0, 1) == 1; }
  /// A row's value with its interval, or with neither.
  Json row() {
    Json out = Json::object();
    if (whole(0, 9) == 0) return out;
    const double value = offset_ + scale_ * real(signs_ ? -1 : 0.01, 1), u = scale_ * real(0, 0.4);
    out["value"] = value;
    if (whole(0, 4) > 0) out["low"] = value - u, out["high"] = value + u;
    return out;
  }
  /// A word of its own, and some more.
  std::string name(int k) {
    std::string out = "n" + std::to_string(k) + "q";
    for (int more = whole(0, longest_); more > 0; --more) out += coin() ? " penalty" : " stiffness 1e8 N/m,";
    return out;
  }
  void next() {
    scale_ = std::pow(10.0, whole(-7, 7));
    offset_ = whole(0, 3) == 0 ? 30 * scale_ : 0;
    signs_ = coin();
    longest_ = coin() ? 0 : 6;
  }
  double scale() const { return scale_; }
  double value() { return offset_ + scale_ * real(signs_ ? -1.2 : 0.01, 1.2); }

 private:
  std::mt19937 engine_;
  double scale_ = 1, offset_ = 0;
  bool signs_ = false;
  int longest_ = 0;
};

Json with(Json names, const Json& row) {
  names.update(row);
  return names;
}

/// Whiskers stand in the order of rows that have one.
void check_whiskers(const Drawn& drawn, const Json& rows) {
  const auto scale = told(drawn, false, in_logarithms(drawn));
  if (!scale) return;
  std::size_t k = 0;
  // A place has two decimals, a tick its own digits.
  constexpr double tolerance = 0.1;
  for (const Json& row : rows) {
    if (!row.contains("low")) continue;
    REQUIRE(k < drawn.whiskers.size());
    CHECK(drawn.whiskers[k].x1 == Approx(scale->at(row["low"])).margin(tolerance));
    CHECK(drawn.whiskers[k].x2 == Approx(scale->at(row["high"])).margin(tolerance));
    ++k;
  }
  CHECK(k == drawn.whiskers.size());
}

void check_lines(const Drawn& drawn, std::vector<double> at, bool upright) {
  const auto scale = told(drawn, upright, !upright && in_logarithms(drawn));
  std::vector<double> places;
  for (const Line& line : drawn.lines)
    if (line.classes == "at") places.push_back(upright ? line.y1 : line.x1);
  // A line is in pieces where a label stands.
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const Line& line : drawn.lines)
    for (const Words& one : drawn.words)
      if (!upright && line.classes == "at" && (one.classes.empty() || one.classes == "heading"))
        CHECK_FALSE((one.left < line.x1 && line.x1 < one.right && line.y1 < one.base - 3 && line.y2 > one.base - 8));
  std::sort(at.begin(), at.end());
  REQUIRE(places.size() == at.size());
  for (std::size_t k = 0; scale && k < at.size(); ++k) CHECK(places[k] == Approx(scale->at(at[k])).margin(0.1));
  CHECK(std::count_if(drawn.words.begin(), drawn.words.end(), [](const Words& one) { return one.classes == "at"; }) ==
        static_cast<std::ptrdiff_t>(at.size()));
}

constexpr int trials = 25;

}  // namespace

TEST_CASE("a figure of bars holds every whisker, names every row and has its lines where they belong",
          "[report][asks]") {
  Random random(1);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    Json figure = {
        {"form", "bars"}, {"measure", "peak force"}, {"unit", "N"}, {"rows", Json::array()}, {"at", Json::array()}};
    const int groups = random.whole(1, 3), rows = random.whole(1, 25);
    std::vector<std::string> names;
    for (int g = 0; g < groups; ++g)
      for (int k = 0; k < rows; ++k) {
        names.push_back(random.name(100 * g + k));
        figure["rows"].push_back(
            with({{"name", names.back()}, {"group", groups == 1 ? "" : "stop" + std::to_string(g)}}, random.row()));
      }
    std::vector<double> at;
    for (int k = random.whole(0, 2); k > 0; --k) at.push_back(random.value());
    figure["at"] = at;
    INFO(figure.dump());
    const Drawn drawn = read(figure_svg(figure));
    check_within(drawn);
    check_apart(drawn);
    for (const std::string& name : names) check_named(drawn, name);
    check_whiskers(drawn, figure["rows"]);
    check_lines(drawn, at, false);
    for (int g = 0; groups > 1 && g < groups; ++g) check_named(drawn, "stop" + std::to_string(g));
    // Each row has its dot, or says that it has none.
    const auto values = std::count_if(figure["rows"].begin(), figure["rows"].end(),
                                      [](const Json& row) { return row.contains("value"); });
    CHECK(drawn.dots.size() == static_cast<std::size_t>(values));
    CHECK(std::count_if(drawn.words.begin(), drawn.words.end(), [](const Words& one) {
            return one.text == "no value";
          }) == static_cast<std::ptrdiff_t>(names.size()) - values);
  }
}

TEST_CASE("bars that are sorted fall from the largest to the least", "[report][asks]") {
  Random random(2);
  random.next();
  Json figure = {{"form", "bars"}, {"measure", "wear"}, {"unit", "W"}, {"sorted", true}, {"rows", Json::array()}};
  for (int k = 0; k < 12; ++k)
    figure["rows"].push_back({{"name", ""}, {"group", "p" + std::to_string(k)}, {"value", random.value()}});
  Drawn drawn = read(figure_svg(figure));
  REQUIRE(drawn.dots.size() == 12);
  std::sort(drawn.dots.begin(), drawn.dots.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  for (std::size_t k = 1; k < drawn.dots.size(); ++k) CHECK(drawn.dots[k].first <= drawn.dots[k - 1].first);
  for (int k = 0; k < 12; ++k) check_named(drawn, "p" + std::to_string(k));
}

TEST_CASE("a figure of pairs has a row for each, with every level in a lane of its own", "[report][asks]") {
  Random random(3);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    Json figure = {{"form", "pairs"}, {"measure", "peak force"}, {"unit", "N"}, {"rows", Json::array()}};
    const int pairs = random.whole(1, 12), levels = random.whole(2, 5);
    std::vector<std::string> names;
    for (int p = 0; p < pairs; ++p) {
      names.push_back(random.name(p));
      for (int k = 0; k < levels; ++k)
        figure["rows"].push_back(with({{"pair", names.back()}, {"name", "level" + std::to_string(k)}}, random.row()));
    }
    INFO(figure.dump());
    const Drawn drawn = read(figure_svg(figure));
    check_within(drawn);
    check_apart(drawn);
    for (const std::string& name : names) check_named(drawn, name);
    for (int k = 0; k < levels; ++k) check_named(drawn, "level" + std::to_string(k));
    check_whiskers(drawn, figure["rows"]);
    for (std::size_t k = 1; k < drawn.whiskers.size(); ++k) CHECK(drawn.whiskers[k].y1 > drawn.whiskers[k - 1].y1 + 6);
  }
}

TEST_CASE("stretches of one group have one colour, that of its name in the legend", "[report][asks]") {
  Json figure = {{"form", "ranges"}, {"x", "amplitude"}, {"x_unit", "m"}, {"rows", Json::array()}};
  const std::vector<std::string> colours = {"#5B5B5B", "#6A3D9A", "#D55E00"};
  // More motions than a palette has colours, in three groups.
  for (int k = 0; k < 30; ++k)
    figure["rows"].push_back({{"name", "n0q"},
                              {"motion", "period " + std::to_string(k)},
                              {"group", "g" + std::to_string(k % 3) + "q"},
                              {"colour", colours[static_cast<std::size_t>(k % 3)]},
                              {"from", k},
                              {"to", k + 1}});
  const std::string svg = figure_svg(figure);
  for (std::size_t k = 0; k < colours.size(); ++k) {
    std::size_t count = 0;
    for (std::size_t at = svg.find("--c:" + colours[k]); at != std::string::npos;
         at = svg.find("--c:" + colours[k], at + 1))
      ++count;
    CHECK(count == 11);  // ten stretches, and the name
    check_named(read(svg), "g" + std::to_string(k) + "q");
  }
}

TEST_CASE("values along an axis stand over it, ranges are shaded where they are", "[report][asks]") {
  Random random(4);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    Json figure = {{"form", "along"}, {"measure", "impacts"}, {"unit", ""},
                   {"along", "gap"},  {"along_unit", "m"},    {"rows", Json::array()}};
    const int series = random.whole(1, 6), points = random.whole(1, 9);
    const double first = std::pow(10.0, random.whole(-5, 3));
    std::vector<Json> ranges;
    for (int s = 0; s < series; ++s)
      for (int k = 0; k < points; ++k)
        figure["rows"].push_back(
            with({{"series", "n" + std::to_string(s) + "q penalty"}, {"x", first * (k + 1)}}, random.row()));
    figure["between"] = {{first, 2 * first}};
    std::vector<double> at = {random.value()};
    figure["at"] = at;
    INFO(figure.dump());
    const Drawn drawn = read(figure_svg(figure));
    check_within(drawn);
    check_apart(drawn);
    for (int s = 0; series > 1 && s < series; ++s) check_named(drawn, "n" + std::to_string(s) + "q penalty");
    check_lines(drawn, at, true);
    const auto shaded =
        std::find_if(drawn.boxes.begin(), drawn.boxes.end(), [](const Line& box) { return box.classes == "between"; });
    REQUIRE(shaded != drawn.boxes.end());
    if (const auto scale = told(drawn, false, false)) {
      CHECK(shaded->x1 == Approx(scale->at(first)).margin(0.5));
      CHECK(shaded->x2 == Approx(scale->at(2 * first)).margin(0.5));
    }
    const auto scale = told(drawn, true, false);
    std::size_t k = 0;
    for (const Json& row : figure["rows"]) {
      if (!row.contains("low")) continue;
      REQUIRE(k < drawn.whiskers.size());
      const Line& whisker = drawn.whiskers[k++];
      if (!scale) continue;
      CHECK(whisker.y1 == Approx(scale->at(row["low"])).margin(0.1));
      CHECK(whisker.y2 == Approx(scale->at(row["high"])).margin(0.1));
    }
    CHECK(k == drawn.whiskers.size());
  }
}

TEST_CASE("parts add up along their row, and the share that is asked is a line", "[report][asks]") {
  Random random(5);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    Json figure = {{"form", "parts"},
                   {"measure", "wear power"},
                   {"unit", "%"},
                   {"at", {random.real(0.1, 20)}},
                   {"rows", Json::array()}};
    const int bars = random.whole(1, 20);
    std::vector<double> sums;
    std::vector<std::string> names;
    for (int b = 0; b < bars; ++b) {
      names.push_back(random.name(b));
      sums.push_back(0);
      for (const char* part : {"step", "mesh", "sampling"}) {
        const double value = random.scale() * random.real(0, 1);
        sums.back() += value;
        figure["rows"].push_back({{"name", names.back()}, {"part", part}, {"value", value}});
      }
    }
    INFO(figure.dump());
    const Drawn drawn = read(figure_svg(figure));
    check_within(drawn);
    check_apart(drawn);
    for (const std::string& name : names) check_named(drawn, name);
    for (const char* part : {"step", "mesh", "sampling"}) check_named(drawn, part);
    check_lines(drawn, {figure["at"][0].get<double>()}, false);
    std::vector<Line> parts;
    for (const Line& box : drawn.boxes)
      if (box.classes.starts_with("part")) parts.push_back(box);
    parts.erase(parts.begin(), parts.begin() + 3);  // of the legend
    REQUIRE(parts.size() == 3 * sums.size());
    const auto scale = told(drawn, false, false);
    for (std::size_t b = 0; scale && b < sums.size(); ++b) {
      CHECK(parts[3 * b].x1 == Approx(scale->at(0)).margin(0.1));
      CHECK(parts[3 * b + 1].x1 == Approx(parts[3 * b].x2).margin(0.03));
      CHECK(parts[3 * b + 2].x2 == Approx(scale->at(sums[b])).margin(0.1));
    }
  }
}

TEST_CASE("curves of logarithms leave out what has none, and hold their floors", "[report][asks]") {
  Random random(6);
  for (int trial = 0; trial < trials; ++trial) {
    Json figure = {{"form", "curves"}, {"x", "step (s)"},         {"y", "error of the tip (m)"},
                   {"log", true},      {"series", Json::array()}, {"at", {1e-4}}};
    const int series = random.whole(1, 6);
    for (int s = 0; s < series; ++s) {
      Json points = Json::array();
      for (int k = 0; k < 6; ++k) points.push_back({1e-3 * std::pow(0.5, k), std::pow(10, random.real(-9, 1))});
      points.push_back({1e-3, 0.0});
      figure["series"].push_back({{"name", "n" + std::to_string(s) + "q"},
                                  {"points", points},
                                  {"floor", random.coin() ? Json(std::pow(10, random.real(-14, -3))) : Json(nullptr)}});
    }
    INFO(figure.dump());
    const std::string svg = figure_svg(figure);
    const Drawn drawn = read(svg);
    check_within(drawn);
    check_apart(drawn);
    CHECK(all_of(svg, "<title>").size() == static_cast<std::size_t>(6 * series));
    CHECK(in_logarithms(drawn));
  }
}

TEST_CASE("a curve follows the order of its points, and the legend names what is drawn", "[report][asks]") {
  Json figure = {{"form", "curves"},
                 {"x", "time"},
                 {"y", "error"},
                 {"series",
                  {{{"name", "one"}, {"points", {{3, 1}, {1, 2}, {2, 3}}}, {"floor", 0.5}},
                   {{"name", "empty"}, {"points", Json::array()}, {"floor", 100}}}}};
  const std::string svg = figure_svg(figure);
  const Drawn drawn = read(svg);
  check_within(drawn);
  check_apart(drawn);
  check_named(drawn, "one");
  check_named(drawn, "error floor");
  CHECK(svg.find("empty") == std::string::npos);
  const auto way =
      all_of(svg, R"re(<path d="M([0-9.]+) [0-9.]+L([0-9.]+) [0-9.]+L([0-9.]+) [0-9.]+" class="way s0")re");
  REQUIRE(way.size() == 1);
  CHECK(std::stod(way[0][2]) < std::stod(way[0][3]));
  CHECK(std::stod(way[0][3]) < std::stod(way[0][1]));
  figure["series"][0].erase("floor");
  CHECK(figure_svg(figure).find("error floor") == std::string::npos);
}

TEST_CASE("stretches of an axis are boxes between their ends, motions have a colour each", "[report][asks]") {
  Random random(8);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    Json figure = {{"form", "ranges"}, {"x", "pulsation"}, {"x_unit", "rad/s"}, {"rows", Json::array()}};
    const int names = random.whole(1, 12);
    std::vector<std::pair<double, double>> ends;
    std::vector<std::string> all;
    for (int k = 0; k < names; ++k) {
      all.push_back(random.name(k));
      double from = random.scale() * random.real(1, 2);
      for (int part = random.whole(1, 4); part > 0; --part) {
        const double to = from + random.scale() * random.real(0.1, 1);
        ends.emplace_back(from, to);
        figure["rows"].push_back(
            {{"name", all.back()}, {"motion", "period " + std::to_string(part)}, {"from", from}, {"to", to}});
        from = to;
      }
    }
    INFO(figure.dump());
    const Drawn drawn = read(figure_svg(figure));
    check_within(drawn);
    check_apart(drawn);
    for (const std::string& name : all) check_named(drawn, name);
    check_named(drawn, "pulsation (rad/s)");
    std::vector<Line> parts = drawn.boxes;
    REQUIRE(parts.size() >= ends.size());
    parts.erase(parts.begin(), parts.end() - static_cast<std::ptrdiff_t>(ends.size()));  // behind the legend
    const auto scale = told(drawn, false, false);
    for (std::size_t k = 0; scale && k < ends.size(); ++k) {
      CHECK(parts[k].x1 == Approx(scale->at(ends[k].first)).margin(0.1));
      CHECK(parts[k].x2 == Approx(scale->at(ends[k].second)).margin(0.1));
    }
  }
}

TEST_CASE("what is not stable of a branch is broken, every special point has its mark", "[report][asks]") {
  Json points = Json::array();
  for (int k = 0; k < 30; ++k) points.push_back({0.1 * k, std::sin(0.1 * k), k < 10 || k >= 20});
  Json figure = {
      {"form", "branches"},
      {"x", "amplitude"},
      {"x_unit", "m"},
      {"y", "displacement"},
      {"y_unit", "m"},
      {"series",
       {{{"name", "fine"}, {"points", points}}, {{"name", "coarse"}, {"points", {{0, 0.2, false}, {1, -0.4, false}}}}}},
      {"marks",
       {{{"name", "fine"}, {"kind", "fold"}, {"branch", "a"}, {"value", 1.0}, {"tip", 0.84}},
        {{"name", "fine"}, {"kind", "graze"}, {"branch", "a"}, {"value", 5.0}, {"tip", 2.0}},
        {{"name", "fine"}, {"kind", "graze"}, {"branch", "a"}, {"value", 5.0}}}}};
  const std::string svg = figure_svg(figure);
  const Drawn drawn = read(svg);
  check_within(drawn);
  check_apart(drawn);
  // One of them, and that of the other branch, in the legend.
  CHECK(all_of(svg, "class=\"branch s0\"").size() == 3);
  CHECK(all_of(svg, "class=\"branch s1\"").size() == 1);
  // Two special points and two words of the legend, in one colour that is no branch's.
  CHECK(all_of(svg, "class=\"dot s7\"").size() == 4);
  CHECK(all_of(svg, "class=\"branch s0 unstable\"").size() == 1);
  CHECK(all_of(svg, "class=\"branch s1 unstable\"").size() == 1);
  CHECK(all_of(svg, "<title>fold: a at 1<").size() == 1);
  CHECK(all_of(svg, "<title>graze: a at 5<").size() == 1);
  for (const char* one : {"fine", "coarse", "fold", "graze", "unstable", "amplitude (m)", "displacement (m)"})
    check_named(drawn, one);
}

TEST_CASE("no two of thirty-two series have the same sign", "[report][asks]") {
  Json figure = {{"form", "curves"}, {"x", "h"}, {"y", "e"}, {"series", Json::array()}};
  for (int k = 0; k < 32; ++k) figure["series"].push_back({{"name", "n" + std::to_string(k)}, {"points", {{1, k}}}});
  std::set<std::string> signs;
  const std::string svg = figure_svg(figure);
  // A triangle has a level side, a rhombus has none.
  for (const auto& one : all_of(svg, R"re(<(circle|rect|path d="M[^h"]*h|path d="M[^h"]*z)[^>]*class="(dot s\d))re"))
    signs.insert(one[1].str().substr(0, 4) + one[1].str().back() + one[2].str());
  CHECK(signs.size() == 32);
}

TEST_CASE("bars of steps are logarithmic where they are asked to be", "[report][asks]") {
  Json figure = {{"form", "bars"},      {"measure", "largest step"},
                 {"unit", "s"},         {"log", true},
                 {"at", Json::array()}, {"rows", {{{"name", "a"}, {"value", 0.1}}, {{"name", "b"}, {"value", 0.3}}}}};
  CHECK(in_logarithms(read(figure_svg(figure))));
  figure["rows"][0]["value"] = 0.0;
  CHECK_FALSE(in_logarithms(read(figure_svg(figure))));
}

TEST_CASE("figures without anything to draw are none, and odd values are let be", "[report][asks]") {
  CHECK(figure_svg(nullptr).empty());
  CHECK(figure_svg({{"form", "own"}}).empty());
  CHECK(figure_svg({{"form", "bars"}, {"rows", Json::array()}}).empty());
  CHECK(figure_svg({{"form", "pairs"}}).empty());
  CHECK(figure_svg({{"form", "along"}, {"rows", Json::array()}}).empty());
  CHECK(figure_svg({{"form", "curves"}, {"log", true}, {"series", {{{"name", "a"}, {"points", {{1, 0.0}}}}}}}).empty());
  const auto bars = [](Json rows) {
    return Json{{"form", "bars"}, {"measure", "m"}, {"unit", "N"}, {"rows", std::move(rows)}};
  };
  // None has a value; all are the same; zero alone; what is no number.
  for (const Json& rows :
       {Json{{{"name", "a"}}}, Json{{{"name", "a"}, {"value", 7.0}}, {{"name", "b"}, {"value", 7.0}}},
        Json{{{"name", "a"}, {"value", 0.0}}},
        Json{{{"name", "a"}, {"value", NAN}}, {{"name", "b"}, {"value", 1.0}, {"low", -INFINITY}, {"high", INFINITY}}},
        Json{{{"name", "<b>&amp;"}, {"value", 1e300}}, {{"name", "b"}, {"value", -1e300}}},
        Json{{{"name", "a"}, {"value", 12345.671}}, {{"name", "b"}, {"value", 12345.674}}},
        Json{{{"name", "a"}, {"value", 1e9 + 1e-4}}, {{"name", "b"}, {"value", 1e9}}}}) {
    INFO(rows.dump());
    const Drawn drawn = read(figure_svg(bars(rows)));
    check_within(drawn);
    check_apart(drawn);
  }
  CHECK(figure_svg(bars({{{"name", "<script>"}, {"value", 1.0}}})).find("<script>") == std::string::npos);
}

TEST_CASE("axes hold their values between round ends", "[report][asks]") {
  Random random(7);
  for (int trial = 0; trial < 150; ++trial) {
    random.next();
    std::vector<double> values;
    for (int k = random.whole(1, 5); k > 0; --k) values.push_back(random.value());
    const bool logarithms = random.coin();
    if (logarithms)
      for (double& one : values) one = std::abs(one);
    const FigureAxis axis(values, logarithms, 10, 90, 5);
    for (const double value : values) {
      INFO(value);
      CHECK(axis.at(value) > 10 - 1e-6);
      CHECK(axis.at(value) < 90 + 1e-6);
    }
    CHECK(axis.ticks().size() >= 1);
    CHECK(axis.ticks().size() <= 9);
    for (std::size_t k = 1; k < axis.ticks().size(); ++k) {
      CHECK(axis.ticks()[k].first > axis.ticks()[k - 1].first);
      CHECK(axis.ticks()[k].second != axis.ticks()[k - 1].second);
      // What a tick says is where it stands.
      CHECK(number_of(axis.ticks()[k].second) ==
            Approx(axis.ticks()[k].first).margin(1e-6 * (axis.high() - axis.low())));
    }
  }
}

}  // namespace ask_figure_tests
