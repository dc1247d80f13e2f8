#include "runners/study/histories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/scene/history/time_history.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/scene_keys.hpp"
#include "runners/study/study_files.hpp"

namespace ricochet {
namespace {

using namespace keys;

// What repeats says so.
Field period_key(const char* text) {
  return quiet(single(real("period", "s", positive, 0.0, text)));
}

std::vector<Field> table_fields(const char* unit, std::vector<std::string> between, std::vector<std::string> beyond) {
  const std::string value = std::string("Column of the values, in ") + unit + ".";
  const std::string first = between.front();
  return {of_form(Field::Form::text, "file", std::nullopt, "CSV with a header, in the folder of the study."),
          of_form(Field::Form::text, "time", Json("t"), "Column of the instants, in s."),
          of_form(Field::Form::text, "value", std::nullopt, value.c_str()).as("column"),
          real("factor", "1", any, 1.0, "What the values are multiplied by.").as("factor", "the factor of a table"),
          word("interpolation", std::move(between), first, "Between entries: straight, a natural spline, or steps."),
          word("before", beyond, "error", "Before the first entry."),
          word("after", beyond, "error", "After the last entry."),
          period_key("After which the table repeats: from its first entry to its last, which are alike.")};
}

// A formula in t, sampled: motions need what belongs together of displacement, velocity and acceleration.
ObjectForm sampled(const char* unit) {
  ObjectForm keys;
  keys.fields = {single(formula("formula", unit, "t", false, std::nullopt, "In t, at the instants.")),
                 single(real("every", "s", positive, std::nullopt, "Between instants; of a period, at most.")),
                 quiet(single(real("until", "s", positive, 0.0, "The last instant; none of what repeats."))),
                 word("after", {"error", "zero", "hold"}, "error", "After it."),
                 period_key("After which it repeats."),
                 quiet(single(real("pulsation", "rad/s", positive, 0.0, "2π over the period.")))};
  return keys;
}

ObjectForm harmonic() {
  ObjectForm keys;
  keys.fields = {
      single(real("amplitude", "m", any, std::nullopt, "A of A sin(ωt + ψ).").as("A", "the amplitude of a motion")),
      single(real("pulsation", "rad/s", positive, std::nullopt, "ω.").as("ω", "the pulsation of a motion")),
      single(real("phase", "rad", any, 0.0, "ψ.").as("ψ", "the phase of a motion"))};
  return keys;
}

Field history(const char* key, const char* unit, const char* text, std::vector<ObjectForm> ways) {
  ObjectForm either;
  either.ways = std::move(ways);
  Field field = object(key, std::nullopt, text, std::move(either));
  field.spec.unit = unit;
  return field;
}

ObjectForm start_form() {
  ObjectForm keys;
  keys.fields = {
      single(real("displacement", "m", any, 0.0, "φ(0); null, of what repeats: the one without a mean of φ.")),
      single(real("velocity", "m/s", any, 0.0, "φ'(0); null, of what repeats: the one without drift."))};
  for (Field& field : keys.fields) field.nullable = true;
  return keys;
}

TimeTable::Beyond beyond(const std::string& word) {
  if (word == "zero") return TimeTable::Beyond::zero;
  return word == "hold" ? TimeTable::Beyond::hold : TimeTable::Beyond::error;
}

TimeTable::Between between(const std::string& word) {
  if (word == "cubic") return TimeTable::Between::cubic;
  return word == "step" ? TimeTable::Between::step : TimeTable::Between::linear;
}

// The period that a history declares.
void set_period(const Json& json, const std::string& pointer, TimeTable& table) {
  const double pulsation = json.value("pulsation", 0.0);
  table.period = json.value("period", pulsation > 0 ? 2 * std::numbers::pi / pulsation : 0.0);
  if (table.period == 0) return;
  if (json.contains("period") && pulsation > 0)
    throw InputError(pointer + "/pulsation", "stands beside a period; expected one of both");
  if (json.contains("until")) throw InputError(pointer + "/until", "stands beside a period; expected one of both");
  for (const auto& [key, way] : {std::pair("/before", table.before), {"/after", table.after}})
    if (way != TimeTable::Beyond::error)
      throw InputError(pointer + key, "stands beside a period; what repeats has neither beginning nor end");
}

StudyFiles& given(StudyFiles* files, const std::string& pointer) {
  if (!files) throw InputError(pointer + "/file", "a scene that names files stands in a study alone");
  return *files;
}

TimeTable read_table(const Json& json, const std::string& pointer, StudyFiles* files) {
  TimeTable table = given(files, pointer).table(json, pointer);
  const double factor = json.at("factor").get<double>();
  for (double& value : table.values) value *= factor;
  table.between = between(json.at("interpolation").get<std::string>());
  table.before = beyond(json.at("before").get<std::string>());
  table.after = beyond(json.at("after").get<std::string>());
  set_period(json, pointer, table);
  table.check(pointer);
  return table;
}

TimeTable sample(const Json& json, const std::string& pointer, TimeTable::Between between) {
  const Json& given = json.at("formula");
  const Formula formula =
      given.is_number() ? Formula(given.get<double>()) : Formula(given.get<std::string>(), pointer + "/formula", "t");
  TimeTable table;
  table.after = beyond(json.at("after").get<std::string>());
  set_period(json, pointer, table);
  const double every = json.at("every").get<double>(), until = json.value("until", table.period);
  constexpr double most = 1e7;
  if (until == 0)
    throw InputError(pointer + "/until", "missing; expected the last instant in s, or the period of what repeats");
  if (!(until / every >= 1) || until / every > most)
    throw InputError(pointer + "/every",
                     fmt::format("{:.6g} s of instants {:.6g} s apart are {:.3g}; expected 1 to {:g}", until, every,
                                 until / every, most));
  table.name = given.is_number() ? given.dump() : given.get<std::string>();
  const auto count = static_cast<long long>(std::ceil(until / every - 1e-9));
  const double apart = table.period > 0 ? until / static_cast<double>(count) : every;
  for (long long i = 0; i <= count; ++i) {
    const double t = i == count ? until : static_cast<double>(i) * apart;
    table.times.push_back(t);
    table.values.push_back(formula(0, t));
  }
  table.between = between;
  if (table.period > 0) table.check(pointer);
  return table;
}

// φ and φ' at t = 0 of a motion by its acceleration. Of one that repeats φ' has no mean, and null is what leaves none.
std::pair<double, double> read_start(const Json& start, const std::string& pointer, const TimeTable& acceleration) {
  std::pair<double, double> out;
  const auto number = [&](const char* key, double steady) {
    if (!start.at(key).is_null()) return start.at(key).get<double>();
    if (acceleration.period > 0) return steady;
    throw InputError(pointer + "/start/" + key, "null is the start of what repeats; expected a number, or a period");
  };
  const SteadyStart steady = acceleration.period > 0 ? steady_start(acceleration) : SteadyStart{};
  constexpr double round_off = 1e-9;
  if (std::abs(steady.mean_acceleration) > round_off * steady.largest_acceleration)
    throw InputError(pointer + "/acceleration",
                     fmt::format("{} has a mean of {:.6g} m/s² over its period, so the velocity grows without end; "
                                 "expected values whose mean is 0",
                                 acceleration.name, steady.mean_acceleration));
  out = {number("displacement", steady.position), number("velocity", steady.velocity)};
  if (const double drift = out.second - steady.velocity;
      acceleration.period > 0 && std::abs(drift) > 1e-6 * steady.largest_velocity)
    throw InputError(pointer + "/start/velocity",
                     fmt::format("{:.9g} m/s leaves a mean velocity of {:.6g} m/s, a drift; expected {:.15g}, or null, "
                                 "which stands for it",
                                 out.second, drift, steady.velocity));
  if (acceleration.period > 0) out.second = steady.velocity;  // in all its digits
  return out;
}

// S(f) between the entries of a table, straight, or straight in logarithms of both.
std::function<double(double)> tabled_density(const Json& json, const std::string& pointer, const TimeTable& table) {
  const std::vector<double>& f = table.times;
  if (f.size() < 2) throw InputError(pointer, table.name + " has one frequency; expected two or more");
  const double from = json.at("from").get<double>(), to = json.at("to").get<double>();
  if (from < f.front())
    throw InputError(pointer + "/from",
                     fmt::format("{} begins at {:.9g} Hz; expected at least that", table.name, f[0]));
  if (to > f.back())
    throw InputError(pointer + "/to", fmt::format("{} ends at {:.9g} Hz; expected at most that", table.name, f.back()));
  const double factor = json.at("factor").get<double>();
  const bool logarithms = json.at("interpolation") == "log";
  std::vector<double> S = table.values;
  for (std::size_t k = 0; k < S.size(); ++k) {
    S[k] *= factor;
    if (logarithms && !(f[k] > 0 && S[k] > 0))
      throw InputError(pointer + "/interpolation",
                       fmt::format("\"log\" has no S(f) = {:.6g} at {:.6g} Hz; expected \"linear\"", S[k], f[k]));
  }
  return [f, S, logarithms](double at) {
    const auto after = std::upper_bound(f.begin() + 1, f.end() - 1, at);
    const auto k = static_cast<std::size_t>(after - f.begin());
    if (!logarithms) return S[k - 1] + (S[k] - S[k - 1]) * (at - f[k - 1]) / (f[k] - f[k - 1]);
    return S[k - 1] * std::pow(S[k] / S[k - 1], std::log(at / f[k - 1]) / std::log(f[k] / f[k - 1]));
  };
}

void read_spectrum(const Json& json, const std::string& pointer, StudyFiles* files, long long seed, std::size_t number,
                   LoadTerm& term) {
  SpectrumSpec spectrum;
  std::string text;
  if (json.contains("file")) {
    const TimeTable table = given(files, pointer).spectrum(json, pointer);
    text = "of " + table.name;
    spectrum.density = tabled_density(json, pointer, table);
  } else {
    const Json& density = json.at("formula");
    text = "= " + (density.is_number() ? density.dump() : density.get<std::string>());
    const Formula formula = density.is_number() ? Formula(density.get<double>())
                                                : Formula(density.get<std::string>(), pointer + "/formula", "f");
    spectrum.density = [formula](double f) { return formula.value(0, f); };
  }
  spectrum.from = json.at("from").get<double>();
  spectrum.to = json.at("to").get<double>();
  spectrum.lines = json.at("lines").get<int>();
  spectrum.seed = static_cast<std::uint64_t>(seed);
  spectrum.load = number;
  spectrum.pointer = pointer;
  const auto load = std::make_shared<const RandomLoad>(spectrum);
  term.history = {[load](double t) { return load->value(t); }, "random, S(f) " + text, pointer};
  term.period = 2 * load->period();
}

}  // namespace

ObjectForm load_history(const char* unit) {
  ObjectForm table;
  table.fields = table_fields(unit, {"linear", "cubic", "step"}, {"error", "zero", "hold"});
  ObjectForm spectrum;
  const std::string density = std::string("One-sided S(f), (") + unit + ")²/Hz, f in Hz.";
  const std::string squared = std::string(unit) == "1" ? "1/Hz" : std::string(unit) + "²/Hz";
  ObjectForm by_formula, by_table;
  by_formula.fields = {
      of_form(Field::Form::formula, "formula", std::nullopt, density.c_str()).as("S(f) in " + squared)};
  by_formula.fields.front().variables = "f";
  const std::string column = "Column of S(f), in " + squared + ".";
  by_table.fields = {
      of_form(Field::Form::text, "file", std::nullopt, "CSV with a header, in the folder of the study."),
      of_form(Field::Form::text, "frequency", Json("f"), "Column of the frequencies, in Hz."),
      of_form(Field::Form::text, "value", std::nullopt, column.c_str()).as("column"),
      real("factor", "1", positive, 1.0, "What S(f) is multiplied by.").as("factor", "the factor of a spectrum"),
      word("interpolation", {"log", "linear"}, "log", "Between entries: straight in logarithms of both, or straight.")};
  spectrum.ways = {by_formula, by_table};
  spectrum.fields = {single(real("from", "Hz", non_negative, std::nullopt, "Where the first band begins.")),
                     single(real("to", "Hz", positive, std::nullopt, "Where the last band ends.")),
                     integer("lines", {1, 1000000, false, false}, std::nullopt, "Equal bands, a cosine in each.")};
  ObjectForm random;
  random.fields = {
      object("psd", std::nullopt, "Random with this spectrum and the scene's seed.", spectrum).as("random")};
  ObjectForm either;
  either.ways = {table, random};
  return either;
}

ObjectForm stop_motion_form() {
  ObjectForm keys;
  keys.fields = {
      quiet(of_form(Field::Form::text, "component", Json(""), "What a clearance moves along; absent: its first."))};
  keys.ways = motion_form().ways;
  return keys;
}

ObjectForm speed_history() {
  ObjectForm table, either;
  table.fields = table_fields("m/s", {"linear", "step"}, {"error", "zero", "hold"});
  either.ways = {std::move(table), sampled("m/s")};
  return either;
}

ObjectForm motion_form() {
  ObjectForm acceleration;
  acceleration.fields = table_fields("m/s²", {"linear"}, {"error", "zero", "hold"});
  ObjectForm displacement;
  displacement.fields = table_fields("m", {"cubic"}, {"error", "hold"});
  ObjectForm by_acceleration;
  by_acceleration.fields = {history("acceleration", "m/s²", "φ''(t), straight between entries, integrated exactly.",
                                    {acceleration, sampled("m/s²")})
                                .as("acceleration"),
                            object("start", Json::object(), "φ and φ' at t = 0.", start_form()).as("start")};
  ObjectForm by_displacement;
  by_displacement.fields = {history("displacement", "m", "φ(t), a natural spline through the entries, or harmonic.",
                                    {displacement, sampled("m"), harmonic()})
                                .as("displacement")};
  Field supports =
      of_form(Field::Form::words, "supports", Json("all"), "Names of the supports that move so, or \"all\".");
  ObjectForm keys;
  keys.fields = {std::move(supports), component_key("What moves, of a beam of `planes` 2.")};
  keys.ways = {by_acceleration, by_displacement};
  return keys;
}

void read_load_history(const Json& json, const std::string& pointer, StudyFiles* files, long long seed,
                       std::size_t number, LoadTerm& term) {
  if (json.contains("psd")) return read_spectrum(json.at("psd"), pointer + "/psd", files, seed, number, term);
  term.table = std::make_shared<const TimeTable>(read_table(json, pointer, files));
  const auto pieces = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::interpolate(*term.table));
  term.history = {[pieces](double t) { return pieces->value(t); }, term.table->name, pointer};
}

MotionSpec read_motion(const Json& json, const std::string& pointer, StudyFiles* files) {
  MotionSpec motion;
  const Json supports = json.value("supports", Json::array({all_supports}));
  if (supports != Json::array({all_supports})) motion.supports = supports.get<std::vector<std::string>>();
  motion.component = json.value("component", "");
  const bool accelerates = json.contains("acceleration");
  const std::string key = accelerates ? "acceleration" : "displacement", here = pointer + "/" + key;
  const Json& given = json.at(key);
  motion.gives = accelerates ? MotionSpec::Gives::acceleration : MotionSpec::Gives::displacement;
  if (given.contains("amplitude")) {
    const double pulsation = given.at("pulsation").get<double>();
    motion.period = 2 * std::numbers::pi / pulsation;
    motion.history = std::make_shared<const HarmonicMotion>(given.at("amplitude").get<double>(), pulsation,
                                                            given.at("phase").get<double>());
    return motion;
  }
  const TimeTable::Between way = accelerates ? TimeTable::Between::linear : TimeTable::Between::cubic;
  motion.table = std::make_shared<const TimeTable>(given.contains("file") ? read_table(given, here, files)
                                                                          : sample(given, here, way));
  motion.period = motion.table->period;
  if (accelerates) {
    const auto [displacement, velocity] = read_start(json.at("start"), pointer, *motion.table);
    motion.history =
        std::make_shared<const PiecewiseCubic>(PiecewiseCubic::integrate_twice(*motion.table, displacement, velocity));
  } else {
    motion.history = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::interpolate(*motion.table));
  }
  return motion;
}

void read_speed(const Json& given, const std::string& pointer, StudyFiles* files, TangentSpec& tangent) {
  if (given.is_number()) {
    tangent.speed = given.get<double>();
    return;
  }
  TimeTable table =
      given.contains("file") ? read_table(given, pointer, files) : sample(given, pointer, TimeTable::Between::linear);
  MotionSpec motion;
  motion.gives = MotionSpec::Gives::speed;
  motion.period = table.period;
  motion.table = std::make_shared<const TimeTable>(table);
  if (table.period > 0) {
    table.period = 0;
    const PiecewiseCubic way = PiecewiseCubic::interpolate(table).integral();
    tangent.speed = (way.value(table.times.back()) - way.value(table.times.front())) / motion.period;
    table.period = motion.period;
    for (double& value : table.values) value -= tangent.speed;
  }
  motion.history = std::make_shared<const PiecewiseCubic>(PiecewiseCubic::interpolate(table).integral());
  tangent.motion = std::make_shared<const MotionSpec>(std::move(motion));
}

void check_tables(const SceneSpec& scene, double duration) {
  const auto check = [&](const std::shared_ptr<const TimeTable>& table, const std::string& pointer) {
    if (!table || table->covers(0, duration, 1e-9 * duration)) return;
    if (!table->covers(0, 0, 0) && table->times.front() > 0)
      throw InputError(pointer + "/before", fmt::format("{} begins at {:.9g} s, and the run at 0: expected \"zero\" or "
                                                        "\"hold\"",
                                                        table->name, table->times.front()));
    throw InputError(pointer + "/after", fmt::format("{} ends at {:.9g} s, the run at {:.9g} s: expected \"zero\" or "
                                                     "\"hold\", or a duration of at most {:.9g} s",
                                                     table->name, table->times.back(), duration, table->times.back()));
  };
  for (std::size_t i = 0; i < scene.load.terms.size(); ++i)
    check(scene.load.terms[i].table, fmt::format("/scene/load/{}/{}", i, scene.load.terms[i].force ? "force" : "time"));
  for (const GivenMotion& one : given_motions(scene)) check(one.motion->table, one.pointer);
}

std::vector<Json*> histories_with_files(Json& scene) {
  std::vector<Json*> found;
  const auto check_list = [&](const char* list, std::initializer_list<const char*> keys) {
    if (!scene.contains(list) || !scene[list].is_array()) return;
    for (Json& entry : scene[list])
      for (const char* key : keys)
        for (const char* inside : {"", "/psd"})
          if (const Json::json_pointer at(std::string("/") + key + inside + "/file"); entry.contains(at))
            found.push_back(&entry[at.parent_pointer()]);
  };
  check_list("load", {"force", "time"});
  check_list("motions", {"acceleration", "displacement"});
  if (!scene.contains("stops") || !scene["stops"].is_array()) return found;
  for (Json& stop : scene["stops"])
    for (const char* key : {"/moves_with/acceleration", "/moves_with/displacement", "/tangent/speed",
                            "/tangent/0/speed", "/tangent/1/speed"})
      if (stop.contains(Json::json_pointer(std::string(key) + "/file")))
        found.push_back(&stop[Json::json_pointer(key)]);
  return found;
}

}  // namespace ricochet
