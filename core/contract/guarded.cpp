#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <ricochet/contract/check_inertia.hpp>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/float_control.hpp>
#include <ricochet/contract/friction_law.hpp>
#include <ricochet/contract/registry.hpp>

namespace ricochet {
namespace {

// Turns the exception under way into one that says whose it is.
[[noreturn]] void explain(const PluginIdentity& plugin, const char* function) {
  try {
    throw;
  } catch (const PluginFault&) {
    throw;
  } catch (const InputError& error) {
    throw InputError(error.pointer(), one_line(error.what()));
  } catch (const PluginError& error) {
    throw PluginError(one_line(error.what()));
  } catch (const std::bad_alloc&) {
    throw PluginFault(plugin, function, "not enough memory");
  } catch (const std::exception& error) {
    const std::string what = one_line(error.what());
    throw PluginFault(plugin, function, what.empty() ? "an exception that says nothing" : what);
  } catch (...) {
    throw PluginFault(plugin, function, "an exception that says nothing");
  }
}

// One call into a plugin, which leaves the floating-point control word as it was. No allocation and no indirection of
// its own: laws are asked in the marching loop.
template <class Question>
decltype(auto) ask(const PluginIdentity& plugin, const char* function, Question&& question) {
  const PluginCallScope scope(plugin, function);
  const FloatControlOfCall floats(function);
  try {
    return question();
  } catch (...) {
    explain(plugin, function);
  }
}

void check_refusal(const PluginIdentity& plugin, const char* function, Refusal& refusal) {
  if (refusal.sentence.text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw PluginFault(plugin, function, "refuses without a sentence");
  Said& sentence = refusal.sentence;
  // One line, in which marks stay where they are.
  std::replace_if(
      sentence.text.begin(), sentence.text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  sentence.text = cut_short(sentence.text);
  std::erase_if(sentence.marks, [&](const Mark& mark) { return mark.begin + mark.size > sentence.text.size(); });
}

/// What every guard holds. The identity is shared: objects may outlive the registry that made them.
template <class Interface>
class Guard : public Interface {
 public:
  Guard(std::shared_ptr<const PluginIdentity> plugin, std::unique_ptr<Interface> inner)
      : plugin_(std::move(plugin)), inner_(std::move(inner)) {}
  ~Guard() override {
    const PluginCallScope scope(*plugin_, "destructor");
    const FloatControlOfCall floats("destructor");
    inner_.reset();
  }

 protected:
  template <class Question>
  decltype(auto) ask(const char* function, Question&& question) const {
    return ricochet::ask(*plugin_, function, [&]() -> decltype(auto) { return question(*inner_); });
  }
  [[noreturn]] void fault(const char* function, const std::string& what) const {
    throw PluginFault(*plugin_, function, what);
  }

  std::shared_ptr<const PluginIdentity> plugin_;
  std::unique_ptr<Interface> inner_;
};

// Forwards one virtual function that needs no check of its answer.
#define RICOCHET_FORWARD(function, ...) \
  return ask(#function, [&](auto& inner) -> decltype(auto) { return inner.function(__VA_ARGS__); })

class GuardedMass final : public Guard<MassStrategy> {
 public:
  using Guard::Guard;
  InertiaOrRefusal build(const FiniteElementSpace& space) const override {
    InertiaOrRefusal answer = ask("build", [&](auto& inner) { return inner.build(space); });
    if (auto* refusal = std::get_if<Refusal>(&answer))
      check_refusal(*plugin_, "build", *refusal);
    else if (const auto wrong = check_inertia(std::get<Inertia>(answer), space))
      fault("build", *wrong);
    return answer;
  }
  bool takes_given() const override { RICOCHET_FORWARD(takes_given); }
  bool takes_modes() const override { RICOCHET_FORWARD(takes_modes); }
};

class GuardedLaw final : public Guard<ContactLaw> {
 public:
  GuardedLaw(std::shared_ptr<const PluginIdentity> plugin, std::unique_ptr<ContactLaw> inner,
             std::shared_ptr<const std::vector<ParameterSpec>> declared)
      : Guard(std::move(plugin), std::move(inner)), declared_(std::move(declared)) {}
  std::string parameter_of(ParameterRole role) const override {
    for (const ParameterSpec& spec : *declared_)
      if (role != ParameterRole::none && spec.role == role) return spec.key;
    return {};
  }
  bool absent() const override { RICOCHET_FORWARD(absent); }
  std::optional<Evaluation> reads() const override {
    const std::optional<Evaluation> answer = ask("reads", [](auto& inner) { return inner.reads(); });
    if (answer && (static_cast<int>(*answer) < 0 || static_cast<int>(*answer) >= evaluations))
      fault("reads", fmt::format("names the measure {}, which does not exist", static_cast<int>(*answer)));
    return answer;
  }
  bool reads_rate() const override { RICOCHET_FORWARD(reads_rate); }
  bool conserves_energy() const override { RICOCHET_FORWARD(conserves_energy); }
  bool changes_problem() const override { RICOCHET_FORWARD(changes_problem); }
  std::optional<Refusal> prepare_problem(ContactStructure& structure) override {
    const Eigen::Index points = structure.contact->rows(), n = structure.contact->cols();
    auto refusal = ask("prepare_problem", [&](auto& inner) { return inner.prepare_problem(structure); });
    if (refusal) {
      check_refusal(*plugin_, "prepare_problem", *refusal);
      return refusal;
    }
    const SparseMatrix& K = structure.stiffness;
    if (structure.measured.rows() != points || structure.measured.cols() != n || K.rows() != n || K.cols() != n)
      fault("prepare_problem",
            fmt::format("makes {} × {} rows and a stiffness of {} × {}; {} points of {} dofs were given",
                        structure.measured.rows(), structure.measured.cols(), K.rows(), K.cols(), points, n));
    return refusal;
  }
  void prepare(int points, std::span<const Parameters> lanes) override { RICOCHET_FORWARD(prepare, points, lanes); }
  bool per_point() const override { RICOCHET_FORWARD(per_point); }
  void prepare_points(int points, int lanes, std::span<const Parameters> sets) override {
    RICOCHET_FORWARD(prepare_points, points, lanes, sets);
  }
  void solve(ReducedProblem& problem) override { RICOCHET_FORWARD(solve, problem); }
  double potential(const StopState& at) const override { RICOCHET_FORWARD(potential, at); }
  std::optional<ContactSlopes> linear_slopes(int lane) const override { RICOCHET_FORWARD(linear_slopes, lane); }
  bool offers_slopes() const override { RICOCHET_FORWARD(offers_slopes); }
  ContactSlopes slopes(int point, int lane) const override { RICOCHET_FORWARD(slopes, point, lane); }
  double layer(int lane) const override {
    const double answer = ask("layer", [&](auto& inner) { return inner.layer(lane); });
    if (!(answer >= 0) || !std::isfinite(answer)) fault("layer", fmt::format("acts {:g} m before the stop", answer));
    return answer;
  }
  int memory_per_point() const override {
    const int answer = ask("memory_per_point", [](auto& inner) { return inner.memory_per_point(); });
    if (answer < 0 || answer > most_memory)
      fault("memory_per_point", fmt::format("keeps {} numbers per point, 0 to {} are kept", answer, most_memory));
    return answer;
  }
  bool closed_form(int points) const override { RICOCHET_FORWARD(closed_form, points); }
  std::string how_solved() const override {
    return cut_short(ask("how_solved", [](auto& inner) { return inner.how_solved(); }));
  }

 private:
  std::shared_ptr<const std::vector<ParameterSpec>> declared_;
};

class GuardedFriction final : public Guard<FrictionLaw> {
 public:
  using Guard::Guard;
  void prepare(int points, int rows) override { RICOCHET_FORWARD(prepare, points, rows); }
  LaneOutcome solve(FrictionProblem& problem) override { RICOCHET_FORWARD(solve, problem); }
  double creeps(double load_over_bound) const override {
    const double answer = ask("creeps", [&](auto& inner) { return inner.creeps(load_over_bound); });
    if (!(answer >= 0) || !std::isfinite(answer)) fault("creeps", fmt::format("drifts by {:g} m/s", answer));
    return answer;
  }
  double gives_way() const override {
    const double answer = ask("gives_way", [](auto& inner) { return inner.gives_way(); });
    if (!(answer >= 0) || !std::isfinite(answer)) fault("gives_way", fmt::format("gives way by {:g} m per N", answer));
    return answer;
  }
  int memory_per_row() const override {
    const int answer = ask("memory_per_row", [](auto& inner) { return inner.memory_per_row(); });
    if (answer < 0 || answer > most_friction_memory)
      fault("memory_per_row", fmt::format("keeps {} numbers; expected 0 to {}", answer, most_friction_memory));
    return answer;
  }
  double stored(const double* remembered) const override { RICOCHET_FORWARD(stored, remembered); }
  bool must_settle() const override { RICOCHET_FORWARD(must_settle); }
};

class GuardedScheme final : public Guard<TimeScheme> {
 public:
  using Guard::Guard;
  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    PlanOrRefusal answer = ask("plan", [&](auto& inner) { return inner.plan(h, facts); });
    if (auto* refusal = std::get_if<Refusal>(&answer))
      check_refusal(*plugin_, "plan", *refusal);
    else if (const auto wrong = check_plan(std::get<StepPlan>(answer), h))
      fault("plan", "ill-formed plan: " + *wrong);
    return answer;
  }
};

class GuardedMap final : public Guard<ReferenceMap> {
 public:
  using Guard::Guard;
  int size() const override { RICOCHET_FORWARD(size); }
  Eigen::VectorXd start() const override {
    return sized("start", ask("start", [](auto& inner) { return inner.start(); }));
  }
  Eigen::VectorXd weights() const override {
    return sized("weights", ask("weights", [](auto& inner) { return inner.weights(); }));
  }
  std::pair<double, double> tip(const Eigen::VectorXd& x) const override { RICOCHET_FORWARD(tip, x); }
  Image march(const Eigen::VectorXd& x, double span, bool derivative) override {
    Image image = ask("march", [&](auto& inner) { return inner.march(x, span, derivative); });
    if (!image.stopped.empty()) return image;
    sized("march", image.state);
    const Eigen::Index columns = derivative ? size() : 0;
    if (image.derivative.rows() != columns || image.derivative.cols() != columns)
      fault("march", fmt::format("gives a derivative of {} × {}; expected {} × {}", image.derivative.rows(),
                                 image.derivative.cols(), columns, columns));
    return image;
  }

 private:
  Eigen::VectorXd sized(const char* function, Eigen::VectorXd x) const {
    if (x.size() != size()) fault(function, fmt::format("gives {} numbers; its states have {}", x.size(), size()));
    return x;
  }
};

class GuardedReference final : public Guard<ReferenceSolver> {
 public:
  using Guard::Guard;
  bool of_the_mesh() const override { RICOCHET_FORWARD(of_the_mesh); }
  ReferenceOrRefusal solve(const ReferenceProblem& problem, const SampleGrid& grid) const override {
    ReferenceOrRefusal answer = ask("solve", [&](auto& inner) { return inner.solve(problem, grid); });
    if (auto* refusal = std::get_if<Refusal>(&answer)) {
      check_refusal(*plugin_, "solve", *refusal);
    } else {
      const auto& found = std::get<ReferenceMotion>(answer);
      check(found.motion, grid, false);
      check(found.coarser, grid, true);
    }
    return answer;
  }
  ReferenceMapOrRefusal map(const ReferenceProblem& problem) const override {
    ReferenceMapOrRefusal answer = ask("map", [&](auto& inner) { return inner.map(problem); });
    if (auto* refusal = std::get_if<Refusal>(&answer)) {
      check_refusal(*plugin_, "map", *refusal);
      return answer;
    }
    auto& made = std::get<std::unique_ptr<ReferenceMap>>(answer);
    if (!made) fault("map", "returned no object");
    return std::make_unique<GuardedMap>(plugin_, std::move(made));
  }

 private:
  // Only the coarser motion may be absent, series by series.
  void check(const SampledMotion& motion, const SampleGrid& grid, bool optional) const {
    const auto series = [&](const std::vector<double>& values, std::size_t expected, const char* name) {
      if (values.size() != expected && !(optional && values.empty()))
        fault("solve", fmt::format("its {} has {} values where the grid has {}", name, values.size(), expected));
    };
    const std::size_t times = grid.times.size(), fields = times * grid.places.size();
    series(motion.tip, times, "tip");
    series(motion.tip_velocity, times, "tip velocity");
    series(motion.energy, times, "energy");
    series(motion.impulse, times, "impulse");
    series(motion.displacement, fields, "displacement");
    series(motion.strain, fields, "strain");
    series(motion.velocity, fields, "velocity");
  }
};

#undef RICOCHET_FORWARD

template <class Guarded, class Interface, class... More>
Maker<Interface> guard(PluginIdentity plugin, Maker<Interface> make, More... more) {
  return [identity = std::make_shared<const PluginIdentity>(std::move(plugin)), make = std::move(make),
          ... more = std::move(more)](const Parameters& parameters) -> std::unique_ptr<Interface> {
    std::unique_ptr<Interface> made = ask(*identity, "make", [&] { return make(parameters); });
    if (!made) throw PluginFault(*identity, "make", "its factory returned no object");
    return std::make_unique<Guarded>(identity, std::move(made), more...);
  };
}

}  // namespace

Maker<MassStrategy> guarded(PluginIdentity plugin, Maker<MassStrategy> make) {
  return guard<GuardedMass>(std::move(plugin), std::move(make));
}
Maker<ContactLaw> guarded(PluginIdentity plugin, Maker<ContactLaw> make, std::vector<ParameterSpec> declared) {
  return guard<GuardedLaw>(std::move(plugin), std::move(make),
                           std::make_shared<const std::vector<ParameterSpec>>(std::move(declared)));
}
Maker<FrictionLaw> guarded(PluginIdentity plugin, Maker<FrictionLaw> make) {
  return guard<GuardedFriction>(std::move(plugin), std::move(make));
}
Maker<TimeScheme> guarded(PluginIdentity plugin, Maker<TimeScheme> make) {
  return guard<GuardedScheme>(std::move(plugin), std::move(make));
}
Maker<ReferenceSolver> guarded(PluginIdentity plugin, Maker<ReferenceSolver> make) {
  return guard<GuardedReference>(std::move(plugin), std::move(make));
}

}  // namespace ricochet
