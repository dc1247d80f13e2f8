#include <fmt/format.h>

#include <algorithm>

#include "graph.hpp"
#include "power_law.hpp"

namespace {

using namespace ricochet;

/// The force between a loading graph L and an unloading one U ≤ L: p = min(max(κδ + o, U(δ)), L(δ)), κ the steepest
/// slope of both. The offset o = p − κδ stays while the point moves between the graphs, and follows the graph that it
/// meets. κ is no less than any slope, so a way inwards ends on L and one outwards on U.
///
///     E(δ, p) = ∫₀^δ max(U(t), p − κ(δ − t)) dt      what can be given back, J                                   (1)
///     G(x) = ∫₀^x L dt − E(x, L(x)) ≥ 0              lost once L has been followed from 0 to x, J                (2)
struct Hysteresis {
  Graph loading, unloading;
  double steepest = 0;  ///< κ, N/m

  double force(double depth, double offset) const {
    if (!(depth > 0)) return 0;
    return std::min(std::max(steepest * depth + offset, unloading.value(depth)), loading.value(depth));
  }
  double offset(double depth, double before) const { return depth > 0 ? force(depth, before) - steepest * depth : 0.0; }
  /// Where the line of slope κ through (δ, p) leaves the graph U, on the way out.
  double leaves(double depth, double p) const {
    return std::min(unloading.meets(steepest, p - steepest * depth), depth);
  }
  /// Where it meets L on the way in.
  double arrives(double depth, double p) const {
    return std::max(loading.meets(steepest, p - steepest * depth), depth);
  }
  double stored(double depth, double p) const {
    if (!(depth > 0)) return 0;
    const double from = leaves(depth, p);
    return unloading.integral(from) + 0.5 * (unloading.value(from) + p) * (depth - from);
  }
  double lost(double depth) const {
    if (!(depth > 0)) return 0;
    return loading.integral(depth) - stored(depth, loading.value(depth));
  }

  PointForce at(double depth, double rate, double offset) const {
    if (!(depth > 0)) return {};
    const double free = steepest * depth + offset, high = loading.value(depth);
    if (free < high) {
      const double low = unloading.value(depth);
      return free > low ? PointForce{.value = free, .stiffness = steepest}
                        : PointForce{.value = low, .stiffness = unloading.slope(depth)};
    }
    // dG/dx of (2).
    const double slope = loading.slope(depth), per_length = (steepest - slope) * (depth - leaves(depth, high));
    const bool follows = free > high && rate > 0;
    return {.value = high, .stiffness = slope, .dissipation = follows ? per_length * rate : 0.0};
  }

  /// The mean over the way from δ⁻ to δ: along the line of slope κ, then along the graph that it meets.
  PointForce between(double depth, double before, double rate, double offset) const {
    if (depth == before) return at(depth, 0, offset);
    const double p = force(before, offset), way = depth - before;
    const bool inwards = way > 0;
    const double met = inwards ? std::min(arrives(before, p), depth) : std::max(leaves(before, p), depth);
    // Before its stop a point has no line to follow.
    const double meets = before > 0 ? met : before;
    const double part = (meets - before) / way, rest = (depth - meets) / way;
    const PointForce along = (inwards ? loading : unloading).mean(depth, meets);
    const double line = part > 0 ? p + 0.5 * steepest * (meets - before) : 0.0;
    PointForce mean{.value = part * line + rest * along.value,
                    .stiffness = 0.5 * part * part * steepest + rest * rest * along.stiffness +
                                 part * rest * (along.stiffness + along.before)};
    if (inwards && rest > 0) mean.dissipation = std::max(lost(depth) - lost(meets), 0.0) / way * std::max(rate, 0.0);
    return mean;
  }
};

/// A dashpot whose force is a graph of the speed, the same on the way out.
PointForce viscous(const Graph& graph, double rate, const PointForce& share) {
  const double force = std::copysign(graph.value(std::abs(rate)), rate);
  return {.value = force * share.value,
          .stiffness = force * share.stiffness,
          .viscosity = graph.slope(std::abs(rate)) * share.value,
          .before = force * share.before,
          .dissipation = force * share.value * rate};
}

/// Tables of the study: the same at all points and in all lanes. Memory, where there is an unloading table: the offsets
/// o of the lower and of the upper stop, N.
class Tabulated final : public PointwiseContact {
 public:
  Tabulated(const ForceEvaluation& evaluation, const Parameters& parameters)
      : PointwiseContact(evaluation),
        loading_(parameters.table("depth_force")),
        dashpot_(parameters.table("speed_force")) {
    const ParameterTable& back = parameters.table("unloading");
    if (back.empty()) return;
    const Graph unloading(back, loading_.last_slope());
    loop_ = Hysteresis{loading_, unloading, std::max(loading_.steepest(), unloading.steepest())};
  }

  bool reads_rate() const override { return loop_ || !dashpot_.empty(); }
  int memory_per_point() const override { return loop_ ? 2 : 0; }
  // The offset depends on the state as well, and that derivative is not carried.
  bool offers_slopes() const override { return !loop_; }
  std::optional<ContactSlopes> linear_slopes(int) const override {
    if (loop_ || !loading_.straight() || !(dashpot_.empty() || dashpot_.straight())) return std::nullopt;
    ContactSlopes slopes = spring_slopes(loading_.last_slope(), reads());
    slopes.viscosity = dashpot_.last_slope();
    return slopes;
  }
  void solve(ReducedProblem& problem) override {
    problem_ = &problem;
    PointwiseContact::solve(problem);
    for (const int lane : problem.touched)
      if (loop_)
        each_depth(problem, lane, [&](int point, int side, double depth) {
          double& kept = problem.memory_of(lane, memory_of_side(side))[point];
          kept = loop_->offset(depth, kept);
        });
  }
  double potential(const StopState& at) const override {
    if (!loop_) return loading_.integral(at.depth);
    return loop_->stored(at.depth, loop_->force(at.depth, at.memory[memory_of_side(at.side)]));
  }

 private:
  void set_lanes(std::span<const Parameters>) override {}
  double offset(const ContactState& state) const {
    return problem_->memory_of(state.lane, memory_of_side(state.side))[state.point];
  }
  PointForce at(const ContactState& state) const override {
    if (!(state.depth > 0)) return {};
    const PointForce elastic =
        loop_ ? loop_->at(state.depth, state.rate, offset(state))
              : PointForce{.value = loading_.value(state.depth), .stiffness = loading_.slope(state.depth)};
    return dashpot_.empty() ? elastic : beside(elastic, viscous(dashpot_, state.rate, {.value = 1}), state.rate);
  }
  PointForce gradient(const ContactState& state) const override {
    const PointForce elastic = loop_ ? loop_->between(state.depth, state.before, state.rate, offset(state))
                                     : loading_.mean(state.depth, state.before);
    if (dashpot_.empty()) return elastic;
    return beside(elastic, viscous(dashpot_, state.rate, Dashpot::beyond(state)), state.rate);
  }
  double stored(double, int) const override { return 0; }  // potential()

  Graph loading_, dashpot_;
  std::optional<Hysteresis> loop_;
  const ReducedProblem* problem_ = nullptr;  // while it is solved
};

/// Throws InputError where an unloading table and its loading table make no loop that loses.
void check_loop(const ParameterTable& loading, const ParameterTable& unloading) {
  if (unloading.empty()) return;
  if (unloading.back() != loading.back())
    throw InputError(fmt::format("/unloading/{}", unloading.size() - 1),
                     fmt::format("unloading ends at [{}, {}], loading at [{}, {}]; expected the same last row",
                                 unloading.back()[0], unloading.back()[1], loading.back()[0], loading.back()[1]));
  const Graph in(loading), out(unloading);
  constexpr double rounding = 1e-12;
  const auto check = [&](double depth, const std::string& pointer) {
    if (out.value(depth) <= in.value(depth) * (1 + rounding)) return;
    throw InputError(pointer, fmt::format("at a depth of {} m unloading gives {} N and loading {} N; expected no more "
                                          "than loading, else a contact makes energy",
                                          depth, out.value(depth), in.value(depth)));
  };
  for (std::size_t i = 0; i < unloading.size(); ++i) check(unloading[i][0], fmt::format("/unloading/{}", i));
  for (const auto& row : loading) check(row[0], "/unloading");
}

void register_table(Registry& registry) {
  registry.add_contact(
      {.name = "table",
       .summary = "a force read from a table of depths behind each stop",
       .text =
           R"(A point that passes a stop by δ is pushed back with the force that `depth_force` gives: straight lines
          between rows [δ, p], beyond the last one with the last slope. The stop stores the area under the table. With
          `unloading` the force goes in along the first table and out along the second, which ends in the same row. In
          between, a point that turns goes from one to the other with the steepest slope κ of both. A swing from 0 to
          the last row and back loses the area between the tables, a lesser one what it encloses. No way gains energy.
          Each point and side remembers where it is between the tables. With `speed_force` a force of the speed of
          closing comes on top, of the other sign on the way out; the stop never pulls. A table of two rows is the
          penalty, with such a `speed_force` it is kelvin-voigt. )" +
           std::string(damped_evaluation_text) +
           R"(Explicit, the step is limited by √(m/κ). The restitution of the time scheme has no part in it. What
          hysteresis and speed take is reported as dissipated by the law. As a hysteresis remembers, it offers no
          tangents: exponents are those of twins.)",
       .source = R"(straight lines between measured points; hysteresis: the generalised play of Krasnosel'skii and
          Pokrovskii (1989), Systems with Hysteresis, chapter 1, of p − κδ)",
       .parameters = {table_parameter("depth_force", "N against m", false,
                                      "p(δ), force at each depth of a contact point"),
                      table_parameter("unloading", "N against m", true,
                                      "the force on the way out, up to the same last row; none: that of the way in"),
                      table_parameter("speed_force", "N against m/s", true,
                                      "what a speed of closing adds to the force; none: nothing"),
                      evaluation_parameter()}},
      [](const Parameters& p) {
        check_loop(p.table("depth_force"), p.table("unloading"));
        return std::make_unique<Tabulated>(evaluation_of(p), p);
      });
}

}  // namespace

RICOCHET_PLUGIN(contact, table, register_table)
