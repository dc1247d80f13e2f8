#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/engine/flight/closed_steps.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {
namespace {

// Of positions: what round-off leaves between a point that rests and its stop.
constexpr double resting = 64 * 0x1p-52;

// Whether what a rigid law holds in this stage is the position at its end.
bool stops_the_end(const StageProgram& stage, const Stage& plan) {
  return stage.measure_levels.size() == 1 && slot_weights(stage.measure) == slot_weights(plan.update[0]);
}

}  // namespace

std::string ClosedSteps::why_not(const Program& program) {
  if (!program.contact) return "there is none";
  if (program.tangents > 0) return "tangents are taken along";
  if (program.problem->changed_by_law()) return "the law measures no displacements";
  if (program.law->memory_per_point() > 0) return "the law keeps a memory";
  for (int i = 0; i < (program.own_sets ? program.problem->points() : 1); ++i) {
    const int set = program.law_set(i, 0);
    if (program.law->layer(set) != 0) return "the law acts before the stop";
    if (program.law->reads() && !program.law->linear_slopes(set))
      return "the force of the law is not linear in the depth";
  }
  const StageProgram* last = nullptr;
  for (std::size_t k = 0; k < program.stages.size(); ++k) {
    const StageProgram& stage = program.stages[k];
    if (!stage.reads_contact) continue;
    last = &stage;
    if (stage.gate) return "the scheme closes contact by velocities";
    if (stage.restores > 0) return "the scheme gives the work of contact back";
    if (stage.impulse.op) return "efforts move a second unknown";
    if (program.law->reads()) continue;
    if (stage.measure.z == 0) return "the impact measure does not see the effort of its own stage";
    if (!stops_the_end(stage, program.plan.stages[k])) return "what the stops hold is not the end of a stage";
  }
  if (!last) return "no stage reads it";
  if (!program.law->reads() && last != &program.stages.back()) return "the last stage does not read it";
  return "";
}

ClosedSteps::ClosedSteps(const Program& program, FlightSet& free, std::vector<ClosedPoint> closed)
    : rows_(program, free, std::move(closed)), free_(free) {
  const auto n = static_cast<std::size_t>(rows_.modes()), state = static_cast<std::size_t>(rows_.slots()) * n;
  const std::size_t m = rows_.efforts(), steps = static_cast<std::size_t>(longest) + 1;
  for (auto* block : {&start_, &x_[0], &x_[1]}) block->resize(state);
  efforts_.resize((steps + rows_.memory()) * m);
  places_.resize(steps * m);
  tips_.resize(steps);
  impulse_.resize(m);
  rest_.resize(m);
  vector_.resize(2 * n);
}

double ClosedSteps::row(const ClosedRows::Row& row, const double* x, long long step) const {
  double sum = flight_kernels().dot(static_cast<int>(row.x.size()), row.x.data(), x + row.first);
  for (int k = 0; k < rows_.drives(); ++k) sum += row.e[static_cast<std::size_t>(k)] * e_[k];
  const std::size_t m = rows_.efforts();
  for (std::size_t c = 0; c < row.p.size(); ++c)
    if (row.p[c] != 0) sum += row.p[c] * effort(step, c / m, c % m);
  return sum;
}

// p of a step from its rows; false where some point lets go.
bool ClosedSteps::solve(const double* x, long long step) {
  const std::size_t m = rows_.efforts();
  double* p = efforts_.data() + (static_cast<std::size_t>(step) + rows_.memory()) * m;
  for (std::size_t i = 0; i < m; ++i) rest_[i] = rows_.points[i].target - row(rows_.points[i].law, x, step);
  for (std::size_t i = 0; i < m; ++i) {
    p[i] = 0;
    for (std::size_t j = 0; j < m; ++j) p[i] += rows_.solution[i * m + j] * rest_[j];
  }
  for (std::size_t i = 0; i < m; ++i) {
    const ClosedRows::Point& point = rows_.points[i];
    if (!(point.side * p[i] > 0)) return false;
    // A point that slides along its stop is on either side of it, by round-off.
    const double clear = resting * std::abs(point.stop);
    if ((rows_.damps || rows_.means) && !(point.side * (point.stop - row(point.depth, x, step)) > clear)) return false;
    if (rows_.means && !(point.side * (point.stop - row(point.before, x, step)) > clear)) return false;
  }
  for (std::size_t i = 0; i < m; ++i)
    places_[static_cast<std::size_t>(step) * m + i] = row(rows_.points[i].place, x, step);
  return true;
}

const double* ClosedSteps::vector(const ClosedRows::Vector& vector, const double* x, long long step,
                                  double* out) const {
  const FlightKernels& kernels = flight_kernels();
  const std::size_t m = rows_.efforts();
  kernels.row(rows_.modes(), rows_.slots(), rows_.drives(), vector.table.data(), x, e_, out);
  for (const auto& [place, column] : vector.p)
    kernels.add(rows_.modes(), effort(step, place / m, place % m), column.data(), out);
  return out;
}

// The works of a step whose efforts are known.
FlightSums ClosedSteps::works(const double* x, long long step) {
  const FlightKernels& kernels = flight_kernels();
  const int n = rows_.modes();
  const std::size_t m = rows_.efforts(), points = rows_.closed().size();
  FlightSums works;
  for (const ClosedRows::Balance& balance : rows_.balances) {
    for (const ClosedRows::Balance::Loss& loss : balance.losses)
      works.scheme += kernels.quadratic(n, 1, 0, loss.weight.data(), vector(loss.value, x, step, vector_.data()), e_);
    if (balance.displacement.table.empty()) continue;
    const double* s = vector(balance.displacement, x, step, vector_.data());
    if (!balance.damping.empty()) {
      if (balance.along != 0) {
        works.damping += balance.along * kernels.quadratic(n, 1, 0, balance.damping.data(), s, e_);
      } else {
        double* r = vector_.data() + n;
        vector(balance.rate, x, step, r);
        for (int j = 0; j < n; ++j) r[j] *= balance.damping[static_cast<std::size_t>(j)];
        works.damping += kernels.dot(n, s, r);
      }
    }
    for (const auto& [drive, load] : balance.loads) works.loads += e_[drive] * kernels.dot(n, load.data(), s);
    double lift = 0;
    for (int k = 0; k < rows_.drives(); ++k) lift += balance.lift[static_cast<std::size_t>(k)] * e_[k];
    for (std::size_t i = 0; i < points && !balance.work_effort.empty(); ++i) {
      double p = 0;
      for (const auto& [place, weight] : balance.work_effort)
        p += weight * effort(step, (place + i) / m, (place + i) % m);
      works.contact += p * (kernels.dot(n, rows_.row_of_point(i), s) + lift);
      works.loads -= p * lift;
    }
  }
  if (rows_.damps)
    for (std::size_t i = 0; i < m; ++i) {
      const double rate = row(rows_.points[i].rate, x, step);
      works.law += rows_.momentum[i] * rows_.points[i].viscosity * rate * rate;
    }
  works.gain = works.contact - works.damping - works.scheme;
  return works;
}

// Takes the state over; false where other points still push, or a rigid stop does not hold these to round-off.
bool ClosedSteps::begin(const double* const* slots, const double* e, Past past) {
  const std::size_t n = static_cast<std::size_t>(rows_.modes()), points = rows_.closed().size(), m = rows_.efforts();
  for (int j = 0; j < rows_.slots(); ++j) std::copy_n(slots[j], n, start_.data() + static_cast<std::size_t>(j) * n);
  std::copy_n(e, 3, start_e_);
  for (int stage = 0; stage < rows_.stages(); ++stage) {
    if (!rows_.reads(stage)) continue;
    const std::vector<double*>& kept = past[static_cast<std::size_t>(stage)];
    for (std::size_t q = 1; q <= rows_.memory(); ++q) {
      double* to = efforts_.data() + (rows_.memory() - q) * m + static_cast<std::size_t>(rows_.first(stage));
      std::fill_n(to, points, 0.0);
      if (q > kept.size()) continue;
      const double* from = kept[q - 1];
      std::size_t next = 0;
      for (int i = 0; i < rows_.contact_points(); ++i) {
        const bool closed = next < points && rows_.closed()[next].point == i;
        if (closed)
          to[next++] = from[i];
        else if (from[i] != 0)
          return false;
      }
    }
  }
  if (!rows_.rigid) return true;
  std::copy_n(start_e_, 3, e_);
  double size = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < points; ++k) size = std::max(size, std::abs(rows_.row_of_point(k)[i] * start_[i]));
  for (std::size_t k = 0; k < points; ++k)
    if (!(std::abs(row(rows_.start[k], start_.data(), 0) - rows_.points[k].stop) <= resting * size)) return false;
  return true;
}

// Up to `most` steps and the one after; how many of them keep their points.
long long ClosedSteps::run(long long most) {
  const FlightKernels& kernels = flight_kernels();
  const std::size_t m = rows_.efforts();
  const int state = rows_.slots() * rows_.modes();
  sums_ = {};
  penetration_ = 0;
  FlightSums last;
  x_[0] = start_;
  std::copy_n(start_e_, 3, e_);
  std::fill(impulse_.begin(), impulse_.end(), 0.0);
  for (std::size_t q = 0; q < rows_.memory(); ++q)
    for (std::size_t i = 0; i < m; ++i) impulse_[i] += std::abs(efforts_[q * m + i]);
  long long made = 0;
  for (; made <= most; ++made) {
    const double* x = x_[made % 2].data();
    double* next = x_[(made + 1) % 2].data();
    if (!solve(x, made)) break;
    if (made > 0) {
      sums_ += last;
      for (std::size_t i = 0; i < rows_.start.size(); ++i) {
        const ClosedRows::Point& point = rows_.points[i];
        penetration_ = std::max(penetration_, point.side * (point.stop - row(rows_.start[i], x, made)));
      }
      tips_[static_cast<std::size_t>(made) - 1] = row(rows_.tip, x, made);
    }
    last = works(x, made);
    for (std::size_t i = 0; i < m; ++i) impulse_[i] += std::abs(effort(made, 0, i));
    free_.motion().step(x, e_, next);
    for (const auto& [place, column] : rows_.change)
      kernels.add(state, effort(made, place / m, place % m), column.data(), next);
  }
  return made;
}

// Whether all other points stay between their bounds in the state that was looked at and `steps` steps on. Efforts sum
// up to impulse_.
bool ClosedSteps::stays_open(long long steps) {
  FlightBound& bound = free_.bound();
  const std::size_t m = rows_.efforts();
  const auto power =
      static_cast<std::size_t>(std::bit_width(static_cast<unsigned long long>(std::max(1LL, steps) - 1)));
  for (int w = 0; w < bound.watches(); ++w) {
    const FlightWatch& watch = bound.watch(w);
    const std::vector<double>& reach = rows_.reach[static_cast<std::size_t>(w)][power];
    std::size_t next = 0;
    for (int i = 0; i < rows_.contact_points(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (next < rows_.closed().size() && rows_.closed()[next].point == i) {
        ++next;
        continue;
      }
      if (watch.lower[at] == -infinity && watch.upper[at] == infinity) continue;
      double pushed = 0;
      for (std::size_t c = 0; c < m; ++c) pushed += reach[at * m + c] * impulse_[c];
      const FlightBound::Range range = bound.range(w, i, steps);
      if (!(range.low - pushed > watch.lower[at] && range.high + pushed < watch.upper[at])) return false;
    }
  }
  return true;
}

long long ClosedSteps::march(const double* const* slots, const double* e, Past past, long long most) {
  flown_ = 0;
  if (!begin(slots, e, past)) return 0;
  most = std::min({most, longest, free_.bound().longest()});
  const bool others = rows_.contact_points() > static_cast<int>(rows_.closed().size());
  if (others) free_.bound().set_state(start_.data(), e);
  constexpr int attempts = 3;
  for (int attempt = 0; attempt < attempts && most >= 1; ++attempt, most /= 4) {
    const long long made = run(most);
    if (made < 2) return 0;
    if (others && !stays_open(made - 1)) continue;
    flown_ = made - 1;
    at_ = static_cast<int>(flown_ % 2);
    return flown_;
  }
  return 0;
}

void ClosedSteps::leave(double* const* slots, Past past) const {
  const std::size_t n = static_cast<std::size_t>(rows_.modes()), m = rows_.efforts();
  for (int j = 0; j < rows_.slots(); ++j) std::copy_n(x_[at_].data() + static_cast<std::size_t>(j) * n, n, slots[j]);
  for (int stage = 0; stage < rows_.stages(); ++stage) {
    if (!rows_.reads(stage)) continue;
    const std::vector<double*>& kept = past[static_cast<std::size_t>(stage)];
    for (std::size_t q = 0; q < kept.size(); ++q) {
      std::fill_n(kept[q], rows_.contact_points(), 0.0);
      // Efforts from before, as far as anyone asks for them.
      const long long step = flown_ - 1 - static_cast<long long>(q);
      if (step < -static_cast<long long>(rows_.memory())) continue;
      const double* p = efforts_.data() + static_cast<std::size_t>(step + static_cast<long long>(rows_.memory())) * m +
                        static_cast<std::size_t>(rows_.first(stage));
      for (std::size_t i = 0; i < rows_.closed().size(); ++i) kept[q][rows_.closed()[i].point] = p[i];
    }
  }
}

}  // namespace ricochet
