#include "runners/store/snapshots.hpp"

#include <algorithm>
#include <cstring>

namespace ricochet {
namespace {

template <class Whole>
std::vector<double> packed(const std::vector<Whole>& values) {
  std::vector<double> bytes((values.size() * sizeof(Whole) + sizeof(double) - 1) / sizeof(double), 0.0);
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), values.size() * sizeof(Whole));
  return bytes;
}

template <class Whole>
bool unpack(const std::vector<double>& bytes, std::size_t count, std::vector<Whole>& values) {
  if (bytes.size() * sizeof(double) < count * sizeof(Whole)) return false;
  values.resize(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), count * sizeof(Whole));
  return true;
}

// Numbers of a list of words; the words stand beside them.
template <class Values, class Word>
void add_words(const char* name, const Values& values, const Word& word, NumberTable& table) {
  std::vector<double> numbers;
  std::vector<std::string> words;
  for (const auto& one : values) {
    numbers.push_back(static_cast<double>(words.size()));
    words.push_back(word(one));
  }
  table.columns.push_back({name, "", ""});
  table.values.emplace_back(numbers);
  table.words.emplace_back(name, words);
}

// How it is drawn, in columns behind the others.
void add_drawing(const Snapshots& snapshots, NumberTable& table) {
  std::vector<double> held(snapshots.held.begin(), snapshots.held.end()), links, stops, directions, bodies;
  for (const auto& [name, first] : snapshots.bodies) bodies.push_back(first);
  for (const auto& [a, b] : snapshots.links)
    links.insert(links.end(), {static_cast<double>(a), static_cast<double>(b)});
  for (const Snapshots::Stop& stop : snapshots.stops) {
    stops.insert(stops.end(), {stop.at, stop.to});
    directions.insert(directions.end(), stop.direction.begin(), stop.direction.end());
  }
  const std::vector<double> axes(snapshots.axes.begin(), snapshots.axes.end());
  for (const auto& [name, values] : {std::pair<const char*, const std::vector<double>&>("axes", axes),
                                     {"y", snapshots.y},
                                     {"held", held},
                                     {"links", links},
                                     {"stops", stops},
                                     {"directions", directions},
                                     {"body_places", bodies}}) {
    table.columns.push_back({name, "", ""});
    table.values.emplace_back(values);
  }
  add_words(
      "names", snapshots.names, [](const std::string& name) { return name; }, table);
  add_words(
      "stop_names", snapshots.stops, [](const Snapshots::Stop& stop) { return stop.name; }, table);
  add_words(
      "bodies", snapshots.bodies, [](const auto& body) { return body.first; }, table);
}

void take_drawing(const NumberTable& table, Snapshots& out) {
  const auto column = [&](const char* name) {
    const std::vector<double>* values = table.numbers(name);
    return values ? *values : std::vector<double>();
  };
  const auto words = [&](const char* name) {
    const std::vector<std::string>* found = table.words_of(name);
    return found ? *found : std::vector<std::string>();
  };
  out.names = words("names");
  const std::vector<double> axes = column("axes"), links = column("links"), stops = column("stops"),
                            directions = column("directions");
  for (std::size_t k = 0; k < axes.size() && k < out.axes.size(); ++k) out.axes[k] = static_cast<std::size_t>(axes[k]);
  out.y = column("y");
  for (const double one : column("held")) out.held.push_back(static_cast<int>(one));
  for (std::size_t k = 0; k + 1 < links.size(); k += 2)
    out.links.emplace_back(static_cast<int>(links[k]), static_cast<int>(links[k + 1]));
  const std::vector<std::string> stop_names = words("stop_names"), bodies = words("bodies");
  for (std::size_t k = 0; k + 1 < std::min(stops.size(), directions.size()); k += 2)
    out.stops.push_back({stops[k],
                         stops[k + 1],
                         {directions[k], directions[k + 1]},
                         k / 2 < stop_names.size() ? stop_names[k / 2] : ""});
  const std::vector<double> first = column("body_places");
  for (std::size_t b = 0; b < std::min(first.size(), bodies.size()); ++b)
    out.bodies.emplace_back(bodies[b], static_cast<int>(first[b]));
}

}  // namespace

NumberTable table_of(const Snapshots& snapshots) {
  NumberTable table = number_table(snapshots_name, {{"shape", "", ""},
                                                    {"t", "s", ""},
                                                    {"clamp", "m", ""},
                                                    {"x", "m", ""},
                                                    {"displacement", "", ""},
                                                    {"point", "m", ""},
                                                    {"lower", "m", ""},
                                                    {"upper", "m", ""},
                                                    {"pushed", "", ""},
                                                    {"force", "", ""}});
  table.exported = false;
  table.values = {
      {snapshots.along ? 1.0 : 0.0, snapshots.metres, snapshots.newtons, static_cast<double>(snapshots.force.size())},
      snapshots.t,
      snapshots.clamp,
      snapshots.x,
      packed(snapshots.displacement),
      snapshots.point,
      snapshots.lower,
      snapshots.upper,
      packed(snapshots.pushed),
      packed(snapshots.force)};
  add_drawing(snapshots, table);
  if (!snapshots.of.empty()) {
    table.columns.push_back({"of", "", ""});
    table.values.emplace_back(std::vector<double>{0});
    table.words.emplace_back("of", std::vector<std::string>{snapshots.of});
  }
  return table;
}

std::optional<Snapshots> snapshots_of(const NumberTable& table) {
  Snapshots out;
  const auto column = [&](const char* name) {
    const std::vector<double>* values = table.numbers(name);
    return values ? *values : std::vector<double>();
  };
  const std::vector<double> shape = column("shape");
  constexpr std::size_t shape_numbers = 4;
  if (shape.size() != shape_numbers) return std::nullopt;
  out.along = shape[0] != 0;
  out.metres = shape[1];
  out.newtons = shape[2];
  out.t = column("t");
  out.clamp = column("clamp");
  out.x = column("x");
  out.point = column("point");
  out.lower = column("lower");
  out.upper = column("upper");
  take_drawing(table, out);
  if (const auto* of = table.words_of("of"); of && !of->empty()) out.of = of->front();
  const auto forces = static_cast<std::size_t>(shape[3]);
  const bool whole = out.clamp.size() == out.t.size() && out.lower.size() == out.point.size() &&
                     out.upper.size() == out.point.size() && (out.y.empty() || out.y.size() == out.x.size()) &&
                     unpack(column("displacement"), out.t.size() * out.values(), out.displacement) &&
                     unpack(column("pushed"), forces, out.pushed) && unpack(column("force"), forces, out.force);
  if (!whole) return std::nullopt;
  return out;
}

}  // namespace ricochet
