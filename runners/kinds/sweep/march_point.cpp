#include "runners/kinds/sweep/march_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

TipMarch::TipMarch(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan)
    : marcher_(std::move(program)), begin_(plan.strobe + 1), before_(orbits.size()) {
  turn_back();
  for (const Orbit* orbit : orbits) {
    const int lane = static_cast<int>(at_.size());
    marcher_.set_lane(lane, orbit->lane, orbit->entry);
    at_.push_back(marcher_.tip(lane));
  }
}

void TipMarch::march(long long steps, const Use& use) {
  for (long long made = 0; made < steps; ++made, ++made_) {
    marcher_.march(1);
    for (std::size_t lane = 0; lane < at_.size(); ++lane) {
      const double after = marcher_.tip(static_cast<int>(lane));
      if (made_ > 1) use(lane, made_, at_[lane], (after - before_[lane]) / (2 * h()));
      before_[lane] = at_[lane];
      at_[lane] = after;
    }
  }
}

namespace {

// The scenes of a case, added as its run did until the first one that can be marched: that one chose the operator.
class PointScenes {
 public:
  PointScenes(const StudyCase& study_case, const Registry& registry)
      : pointer_(study_case.settings.at("parameter").at("pointer").get<std::string>()),
        starts_(starts_of(study_case.settings)),
        scenes_(study_case, registry) {
    for (const double value : parameter_values(study_case.settings))
      for (const bool state : {false, true})
        if (any_start(starts_, state) && scenes_.groups() == 0) scenes_.add(pointer_, value, state);
  }

  int add(double value, const std::string& start) {
    for (const StartSpec& one : starts_)
      if (one.name == start) return scenes_.add(pointer_, value, one.own_state());
    throw InputError("", "the study has no start \"" + start + "\"");
  }
  const ForcedScenes& scenes() const { return scenes_; }

 private:
  std::string pointer_;
  std::vector<StartSpec> starts_;
  ForcedScenes scenes_;
};

}  // namespace

void march_on(const ForcedScenes& scenes, int scene, const Orbit& orbit, const SectionPlan& plan, SampleCount count,
              const std::function<void(const PointSample&)>& use) {
  TipMarch tips(scenes.program(scenes[scene].group, {orbit.lane}), {&orbit}, plan);
  const int whole = plan.steps_per_period, samples = std::min(count.samples, whole);
  for (int period = 0; period < count.periods; ++period) {
    int taken = 0;  // of this period
    tips.march(whole, [&](std::size_t, long long step, double displacement, double velocity) {
      // A sample for each k with step_of_period = ⌈k·whole/samples⌉.
      const long long step_of_period = step - static_cast<long long>(period) * whole;
      if (step_of_period * samples < static_cast<long long>(taken + 1) * whole) return;
      ++taken;
      use({static_cast<double>(step) * tips.h(), displacement, velocity, step_of_period == whole ? period : -1});
    });
    tips.turn_back();
  }
}

void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use) {
  PointScenes made(study_case, registry);
  const int scene = made.add(task.parameter, task.start);
  const ForcedScene& found = made.scenes()[scene];
  if (!found.refusal.empty()) throw InputError("", found.refusal.text);
  Orbit orbit;
  orbit.lane = found.lane;
  orbit.entry = task.entry;
  march_on(made.scenes(), scene, orbit, section_plan(study_case, made.scenes()), task.count, use);
}

namespace {

constexpr int default_periods = 8, default_samples = 200;
constexpr std::size_t neighbours = 5;
constexpr double same_value = 1e-9;  // relative

}  // namespace

const Table& stored_table(const CaseRecord& record, const std::string& name) {
  if (const Table* table = find_table(record.tables, name)) return *table;
  throw PointRefused(fmt::format("the case {} has no {}: it is {}{}", record.id, name, word(record.status),
                                 record.reasons.empty() ? "" : ", " + record.reason()));
}

SamplePrinter::SamplePrinter(std::ostream& out) : out_(out) {
  out_ << "t,tip_displacement,tip_velocity\n";
}

void SamplePrinter::operator()(const PointSample& sample) {
  out_ << csv_number(sample.time) << ',' << csv_number(sample.displacement) << ',' << csv_number(sample.velocity)
       << '\n';
}

SampleCount wanted_count(const PointRequest& asked) {
  return {asked.periods > 0 ? asked.periods : default_periods, asked.samples > 0 ? asked.samples : default_samples};
}

std::string comparison_text(std::size_t equal, std::size_t compared) {
  if (compared == 0) return "";
  return fmt::format("; {} of {} strobes as stored{}", equal, compared,
                     equal < compared ? ": the results are of another build of the program" : "");
}

std::string nearest_values(const std::vector<double>& values, double wanted) {
  std::vector<double> near = values;
  std::stable_sort(near.begin(), near.end(),
                   [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); });
  near.resize(std::min(near.size(), neighbours));
  std::sort(near.begin(), near.end());
  std::vector<std::string> named;
  for (const double value : near) named.push_back(csv_number(value));
  return fmt::format("{}", fmt::join(named, ", "));
}

bool is_value(double stored, double wanted) {
  return std::abs(stored - wanted) <= same_value * std::max(std::abs(stored), std::abs(wanted));
}

}  // namespace ricochet
