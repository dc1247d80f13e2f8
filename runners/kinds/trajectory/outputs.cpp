#include "runners/kinds/trajectory/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

std::vector<std::string> names_in(const Json& study, const char* list) {
  std::vector<std::string> names;
  const Json& scene = study.at("scene");
  if (scene.contains(list) && scene.at(list).is_array())
    for (const Json& one : scene.at(list)) names.push_back(one.at("name").get<std::string>());
  return names;
}

void check_spectra(const Json& study, const Json& outputs) {
  const std::vector<std::string> stops = names_in(study, "stops"), points = names_in(study, "points");
  std::vector<std::string> all = stops;
  all.insert(all.end(), points.begin(), points.end());
  const Json& spectra = outputs.at("spectra");
  for (std::size_t i = 0; i < spectra.size(); ++i) {
    const std::string pointer = fmt::format("/outputs/spectra/{}/of", i);
    const auto name = spectra[i].at("of").get<std::string>();
    const bool force = spectra[i].at("quantity") == "force";
    if (all.empty())
      throw InputError(pointer, "the scene has neither points nor stops with names; expected one of them");
    const std::vector<std::string>& known = force ? stops : all;
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(
          pointer, known.empty() ? "the scene has no stops with names; expected a displacement of: " + quoted_list(all)
                                 : fmt::format("no {} \"{}\"; there is: {}{}", force ? "stop" : "stop or point",
                                               shortened(name), quoted_list(known), did_you_mean(name, known)));
    for (std::size_t j = 0; j < i; ++j)
      if (spectra[j] == spectra[i])
        throw InputError(fmt::format("/outputs/spectra/{}", i), fmt::format("the same as spectra/{}", j));
  }
  for (const char* key : {"rate", "segment"})
    if (!outputs.contains(key) || outputs.at(key).is_null())
      throw InputError(fmt::format("/outputs/{}", key), "missing; spectra need rate, in Hz, and segment, in s");
  const double rate = outputs.at("rate").get<double>(), segment = outputs.at("segment").get<double>();
  for (const double step : one_or_each<double>(study.at("step")))
    if (step * rate > 1)
      throw InputError("/outputs/rate", fmt::format("{:.6g} Hz is above one sample in a step of {:.6g} s; expected at "
                                                    "most {:.6g} Hz",
                                                    rate, step, 1 / step));
  constexpr double most = 1 << 22;
  const double samples = rate * segment, whole = std::round(samples);
  if (std::abs(samples - whole) > 1e-6 * whole || std::fmod(whole, 2) != 0 || whole < 4 || whole > most)
    throw InputError("/outputs/segment", fmt::format("{:.6g} s at {:.6g} Hz are {:.10g} samples; expected an even "
                                                     "number from 4 to {}",
                                                     segment, rate, samples, most));
  const Json window = study.value("window", Json());
  const double from = window.is_object() ? window.at("from").get<double>() : 0;
  const double to = window.is_object() ? window.at("to").get<double>() : study.at("duration").get<double>();
  if (segment > (to - from) * (1 + 1e-9))
    throw InputError("/outputs/segment",
                     fmt::format("{:.6g} s in {:.6g} s that are looked at; expected at most that", segment, to - from));
}

}  // namespace

int AskedOutputs::segment_samples() const {
  return static_cast<int>(std::lround(rate * segment));
}

Field outputs_key() {
  using namespace keys;
  ObjectForm shocks;
  shocks.fields = {single(real("force_above", "N", non_negative, 0.0, "Contact is a shock while its force is above.")),
                   single(real("rest", "s", non_negative, 0.0, "Apart by less, two are one shock."))};
  ObjectForm spectrum;
  spectrum.fields = {of_form(Field::Form::text, "of", std::nullopt, "Name of a stop or of a point."),
                     word("quantity", {"displacement", "force"}, std::nullopt, "Force: of a stop alone.")};
  ObjectForm outputs;
  outputs.fields = {
      quiet(object("shocks", Json(nullptr), "Shocks at the stops, for shocks.csv; absent: none.", shocks)),
      quiet(integer("classes", {1, 1000, false, false}, 10, "Classes of histogram.csv.")),
      quiet(objects("spectra", "Power spectral densities, for spectra.csv, over the window.", spectrum)),
      quiet(keys::optional(real("rate", "Hz", positive, std::nullopt, "Samples per second of spectra."))),
      quiet(keys::optional(real("segment", "s", positive, std::nullopt, "Length of a segment of Welch's method.")))};
  outputs.fields.front().nullable = true;
  Field field = quiet(object("outputs", Json(nullptr), "What is kept beside measures and curves.", outputs));
  field.nullable = true;
  return field;
}

void check_outputs(const Json& study) {
  const Json outputs = study.value("outputs", Json());
  const Json window = study.value("window", Json());
  const std::size_t stops = names_in(study, "stops").size();
  constexpr std::size_t most = 1000000;
  if (window.is_object() && window.at("parts").is_number() && stops * window.at("parts").get<std::size_t>() > most)
    throw InputError("/window/parts", fmt::format("{} parts of {} stops; expected at most {} together",
                                                  window.at("parts").get<std::size_t>(), stops, most));
  if (!outputs.is_object()) return;
  if (outputs.contains("spectra") && !outputs.at("spectra").empty()) return check_spectra(study, outputs);
  for (const char* key : {"rate", "segment"})
    if (outputs.contains(key) && !outputs.at(key).is_null())
      throw InputError(fmt::format("/outputs/{}", key),
                       "is of spectra, and none is asked for; give outputs.spectra too");
}

AskedOutputs asked_outputs(const StudyCase& study_case) {
  AskedOutputs asked;
  asked.window.to = study_case.duration;
  const Json settings = study_case.settings.is_object() ? study_case.settings : Json::object();
  if (settings.contains("window")) {
    const Json& window = settings.at("window");
    asked.windowed = true;
    asked.window = {window.at("from").get<double>(), window.at("to").get<double>(),
                    window.at("parts").is_number() ? window.at("parts").get<int>() : 1};
  }
  if (!settings.contains("outputs")) return asked;
  const Json& outputs = settings.at("outputs");
  asked.any = true;
  if (outputs.contains("shocks"))
    asked.shocks =
        ShockRule{outputs.at("shocks").at("force_above").get<double>(), outputs.at("shocks").at("rest").get<double>()};
  asked.classes = outputs.value("classes", 10);
  for (const Json& one : outputs.value("spectra", Json::array()))
    asked.spectra.push_back({one.at("of").get<std::string>(), one.at("quantity") == "force"});
  asked.rate = outputs.value("rate", 0.0);
  asked.segment = outputs.value("segment", 0.0);
  return asked;
}

namespace {

int place_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

// Times that are equal but for their rounding.
constexpr double rounding = 1e-6;

}  // namespace

SpectrumTaker::SpectrumTaker(const Marcher& marcher, const AskedOutputs& asked, const AskedSpectrum& of)
    : of_(of),
      window_(asked.window),
      rate_(asked.rate),
      stops_(marcher),
      points_(marcher, marcher.program().problem->observed),
      stop_(place_of(stop_list(*marcher.program().problem).names, of.of)),
      point_(stop_ < 0 ? place_of(marcher.program().problem->observed.names, of.of) : -1),
      spectrum_(asked.rate, asked.segment_samples()),
      last_(static_cast<long long>(std::floor((window_.to - window_.from) * rate_ + rounding))) {
  const Eigen::VectorXd start = marcher.program().model->to_model(marcher.program().lanes.front().position);
  value_ = place(marcher, start.data(), 0);
  // A step or two may be under way while a sample waits.
  if (of_.force) bins_.resize(8 + static_cast<std::size_t>(std::ceil(4 * rate_ * marcher.program().h)));
}

double SpectrumTaker::place(const Marcher& marcher, const double* position, double t) const {
  if (stop_ >= 0) return stops_.displacement(marcher, stop_, position, t);
  return points_.relative(point_, position) + points_.lift(marcher, point_, t);
}

void SpectrumTaker::see(const Marcher& marcher) {
  const double t = marcher.time(), h = marcher.program().h;
  if (of_.force) return flush(t - 2 * h);
  if (t < window_.from - 2 * h || next_ > last_) return;
  const double value = place(marcher, marcher.slot(0), t);
  for (; next_ <= last_; ++next_) {
    const double at = window_.from + static_cast<double>(next_) / rate_;
    if (at > t + rounding * h) break;
    spectrum_.add(value_ + (at - before_) / (t - before_) * (value - value_));
  }
  before_ = t;
  value_ = value;
}

void SpectrumTaker::instant(const ContactInstant& one) {
  if (!of_.force || one.point != stop_) return;
  const double at = (one.time - window_.from) * rate_ + rounding;
  if (at < 0 || at >= static_cast<double>(last_)) return;
  flush(one.time - (static_cast<double>(bins_.size()) - 2) / rate_);
  const auto bin = static_cast<std::size_t>(std::max(static_cast<long long>(at), next_)) % bins_.size();
  bins_[bin] += one.side == StopSide::lower ? one.given : -one.given;
}

// Samples that end before a time.
void SpectrumTaker::flush(double until) {
  for (; next_ < last_ && window_.from + static_cast<double>(next_ + 1) / rate_ <= until; ++next_) {
    double& bin = bins_[static_cast<std::size_t>(next_) % bins_.size()];
    spectrum_.add(bin * rate_);
    bin = 0;
  }
}

void SpectrumTaker::finish(double time) {
  if (of_.force) flush(time * (1 + 1e-9));
}

OutputWatch::OutputWatch(const StudyCase& study_case, const Marcher& marcher, StopContacts& contacts)
    : asked_(asked_outputs(study_case)) {
  const SemiDiscrete& problem = *marcher.program().problem;
  const bool contact = marcher.program().contact;
  if (contact && asked_.windowed && (asked_.any || !problem.stops.empty())) {
    statistics_.emplace(marcher, asked_.window);
    contacts.tell(&*statistics_);
    reads_steps_ = true;
  }
  if (contact && asked_.shocks) {
    shocks_.emplace(contacts.list().count(), *asked_.shocks, asked_.window);
    contacts.tell(&*shocks_);
  }
  spectra_.reserve(asked_.spectra.size());
  for (const AskedSpectrum& one : asked_.spectra) {
    spectra_.emplace_back(marcher, asked_, one);
    reads_steps_ = reads_steps_ || spectra_.back().reads_steps();
  }
  for (SpectrumTaker& one : spectra_) contacts.tell(&one);
  ask(marcher);
}

// Flights may leave out what is before and after the window.
void OutputWatch::ask(const Marcher& marcher) {
  const double h = marcher.program().h, t = marcher.time();
  asks_.next_shown = never;
  if (!reads_steps_ || t > asked_.window.to + 2 * h) return;
  const double left = std::floor((asked_.window.from - t) / h) - 2;
  asks_.next_shown = marcher.program().flight && left > 0 ? marcher.step() + 1 + static_cast<long long>(left) : 0;
}

void OutputWatch::step_done(Marcher& marcher) {
  if (marcher.status(0).running) {
    if (statistics_) statistics_->see(marcher);
    for (SpectrumTaker& one : spectra_) one.see(marcher);
  }
  ask(marcher);
}

void OutputWatch::interval(Marcher& marcher, const StepInterval&) {
  for (SpectrumTaker& one : spectra_)
    if (!one.reads_steps()) one.see(marcher);
  ask(marcher);
}

void OutputWatch::finish(const Marcher& marcher) {
  if (shocks_) shocks_->finish(marcher.time(), marcher.program().h);
  for (SpectrumTaker& one : spectra_) one.finish(marcher.time());
}

const NumberType<OrbitColumns>& orbits_type() {
  static const NumberType<OrbitColumns> all = [] {
    NumberType<OrbitColumns> type("orbits", "One sample of a place within its clearance, of one case.");
    type.add({"stop", "", "Name of the clearance."}, &OrbitColumns::stop)
        .add({"t", "s", "Time of the sample."}, &OrbitColumns::t)
        .add({"first", "m", "Displacement along the first of its components, from its axis."}, &OrbitColumns::first)
        .add({"second", "m", "Displacement along the second."}, &OrbitColumns::second)
        .add({"radius", "m", "Radius of the clearance."}, &OrbitColumns::radius);
    return type;
  }();
  return all;
}

OrbitTaker::OrbitTaker(const Marcher& marcher, const WindowParts& window, long long steps)
    : list_(stop_list(*marcher.program().problem)), places_(marcher) {
  for (int stop = 0; stop < list_.count(); ++stop)
    if (list_.round(stop)) stops_.push_back(stop);
  asks_.next_shown = never;
  if (!any()) return;
  const double h = marcher.program().h;
  from_ = std::clamp(std::llround(window.from / h), 0LL, steps);
  to_ = std::clamp(std::llround(window.to / h), from_, steps);
  count_ = std::clamp<long long>(to_ - from_, 1, most_samples);
  asks_.next_shown = step_of(next_);
}

void OrbitTaker::step_done(Marcher& marcher) {
  if (next_ > count_ || marcher.step() < step_of(next_) || !marcher.status(0).running) return;
  t_.push_back(marcher.time());
  for (const int stop : stops_) {
    const std::array<double, 2> at = places_.components(marcher, stop);
    values_.insert(values_.end(), at.begin(), at.end());
  }
  while (next_ <= count_ && step_of(next_) <= marcher.step()) ++next_;
  asks_.next_shown = next_ > count_ ? never : step_of(next_);
}

NumberTable OrbitTaker::finish() const {
  NumberTable table = orbits_type().head();
  std::vector<std::string> names;
  for (const int stop : stops_) names.push_back(list_.names[static_cast<std::size_t>(stop)]);
  table.words = {{"stop", names}};
  for (std::size_t k = 0; k < stops_.size(); ++k)
    for (std::size_t i = 0; i < t_.size(); ++i) {
      const std::size_t at = 2 * (i * stops_.size() + k);
      table.add({static_cast<double>(k), t_[i], values_[at], values_[at + 1], places_.radius(stops_[k])});
    }
  return table;
}

}  // namespace ricochet
