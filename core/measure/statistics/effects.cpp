#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <ricochet/measure/statistics/effects.hpp>
#include <stdexcept>

namespace ricochet {

namespace {

constexpr std::size_t largest_table = 1'000'000, most_factors = 12, highest_order = 3;
constexpr double decades_for_log = 2, equal = 1e-12, pairs_from = 1.25, round_off = 1e-12;
constexpr double work_of_draws = 4e7;  // combinations × draws
constexpr int fewest_draws = 50;

using Values = std::vector<std::optional<double>>;

/// The factors that have at least two levels with a value, and what becomes of the others.
struct Active {
  std::vector<std::size_t> factors;                  ///< indices
  std::vector<std::vector<std::size_t>> renumbered;  ///< per factor: level → level of the table, npos where dropped
};
constexpr std::size_t npos = static_cast<std::size_t>(-1);

Active find_active(const std::vector<Factor>& factors, const std::vector<char>& has_value, Effects& out) {
  Active active;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Factor& factor = factors[k];
    std::vector<char> present(factor.levels.size(), 0), asked(factor.levels.size(), 0);
    for (std::size_t c = 0; c < has_value.size(); ++c) {
      asked[factor.level[c]] = 1;
      if (has_value[c]) present[factor.level[c]] = 1;
    }
    std::vector<std::size_t> numbers(factor.levels.size(), npos);
    std::size_t count = 0;
    std::string dropped;
    for (std::size_t l = 0; l < numbers.size(); ++l) {
      if (present[l])
        numbers[l] = count++;
      else if (asked[l])
        dropped += (dropped.empty() ? "" : ", ") + factor.levels[l];
    }
    if (!dropped.empty()) out.notes.push_back(fmt::format("no value with {} {}: left out", factor.name, dropped));
    active.renumbered.push_back(std::move(numbers));
    if (count >= 2) {
      active.factors.push_back(k);
      out.shares.push_back({factor.name});
    } else {
      out.shares.push_back({factor.name, 0, 0, 0, dropped.empty() ? "one level" : "one level with a value"});
    }
  }
  return active;
}

/// Main effects, pairs and triples of d factors.
std::vector<FactorMask> told(std::size_t d) {
  std::vector<FactorMask> out;
  for (std::size_t order = 1; order <= std::min(d, highest_order); ++order) {
    std::vector<FactorMask> sets;
    for (FactorMask mask = 1; mask < (FactorMask{1} << d); ++mask)
      if (static_cast<std::size_t>(std::popcount(mask)) == order) sets.push_back(mask);
    // {0,1}, {0,2}, {1,2}: in the order of the factors, not of the numbers.
    std::sort(sets.begin(), sets.end(), [d](FactorMask a, FactorMask b) {
      for (std::size_t k = 0; k < d; ++k)
        if ((a >> k & 1) != (b >> k & 1)) return (a >> k & 1) > (b >> k & 1);
      return false;
    });
    out.insert(out.end(), sets.begin(), sets.end());
  }
  return out;
}

/// A number in (0, 1), the same on every machine.
double fraction(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
}

FactorialTable::Weights draw_weights(const FactorialTable& table, std::mt19937_64& random) {
  FactorialTable::Weights out;
  for (const std::size_t n : table.levels()) {
    std::vector<double> weights(n);
    double sum = 0;
    for (double& w : weights) sum += w = -std::log(fraction(random));
    for (double& w : weights) w /= sum;
    out.push_back(std::move(weights));
  }
  return out;
}

/// Π_{i∈u} (1 − 1/n_i)/(1 − Σp_i²) for every u.
std::vector<double> corrections(const FactorialTable& table, const FactorialTable::Weights& weights) {
  std::vector<double> out = {1};
  for (std::size_t k = 0; k < table.factors(); ++k) {
    double squares = 0;
    for (const double w : weights[k]) squares += w * w;
    const double factor = (1 - 1 / static_cast<double>(table.levels()[k])) / (1 - squares);
    const std::size_t half = out.size();
    for (std::size_t mask = 0; mask < half; ++mask) out.push_back(out[mask] * factor);
  }
  return out;
}

/// Shares of the sets that are told, then of all larger ones, then of repeats.
std::vector<double> shares_of(const std::vector<double>& variances, const std::vector<FactorMask>& sets,
                              double repeats) {
  double total = repeats;
  for (const double v : variances) total += v;
  std::vector<double> out;
  for (const FactorMask set : sets) out.push_back(variances[set] / total);
  double higher = 0;
  for (FactorMask mask = 0; mask < variances.size(); ++mask)
    if (static_cast<std::size_t>(std::popcount(mask)) > highest_order) higher += variances[mask];
  out.push_back(higher / total);
  out.push_back(repeats / total);
  return out;
}

/// One number per combination of the active factors' levels.
struct Table {
  FactorialTable shape;
  std::vector<double> values;  ///< mean of a combination's cells; what fills it where none has a value
  std::vector<char> known;
  double present = 0;             ///< combinations with a value
  double repeats = 0;             ///< mean square of what cells of one combination differ by
  std::vector<double> residuals;  ///< of the model that fills, widened by its freedom
};

Table tabulate(const std::vector<Factor>& factors, const Values& values, const std::vector<char>& has_value,
               const Active& active, std::vector<std::size_t> sizes, bool log) {
  Table out{FactorialTable(std::move(sizes)), {}, {}, 0, 0, {}};
  out.values.assign(out.shape.size(), 0);
  out.known.assign(out.shape.size(), 0);
  std::vector<double> count(out.shape.size(), 0), scaled(values.size(), 0);
  std::vector<std::size_t> place(values.size(), 0), level(active.factors.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (!has_value[c]) continue;
    for (std::size_t k = 0; k < level.size(); ++k)
      level[k] = active.renumbered[active.factors[k]][factors[active.factors[k]].level[c]];
    place[c] = out.shape.index(level);
    scaled[c] = log ? std::log10(*values[c]) : *values[c];
    out.values[place[c]] += scaled[c];
    ++count[place[c]];
  }
  for (std::size_t cell = 0; cell < out.shape.size(); ++cell) {
    if (count[cell] == 0) continue;
    out.values[cell] /= count[cell];
    out.known[cell] = 1;
    ++out.present;
  }
  for (std::size_t c = 0; c < values.size(); ++c)
    if (has_value[c]) out.repeats += std::pow(scaled[c] - out.values[place[c]], 2) / count[place[c]] / out.present;
  return out;
}

/// Fills what is missing; returns why that cannot be done, or "".
std::string complete(Table& table, Effects& out) {
  if (out.missing == 0) return "";
  const std::size_t size = table.shape.size();
  if (2 * out.missing > size) return fmt::format("only {} of {} combinations have a value", table.present, size);
  std::vector<double> fitted;
  if (!table.shape.fit_additive(table.values, table.known, fitted))
    return fmt::format("{} of {} combinations have no value, and the others do not tell the factors apart", out.missing,
                       size);
  for (std::size_t cell = 0; cell < size; ++cell)
    if (!table.known[cell]) table.values[cell] = fitted[cell];
  const bool pairs =
      table.shape.factors() > 1 && table.present >= pairs_from * static_cast<double>(table.shape.freedom(2));
  if (pairs) table.shape.fill_pairs(table.values, table.known, fitted);
  const double free = table.present - static_cast<double>(table.shape.freedom(pairs ? 2 : 1));
  const double widen = free > 0 ? std::sqrt(table.present / free) : 1;
  for (std::size_t cell = 0; cell < size; ++cell)
    if (table.known[cell]) table.residuals.push_back(widen * (table.values[cell] - fitted[cell]));
  out.notes.push_back(fmt::format("{} of {} combinations have no value: filled by {}", out.missing, size,
                                  pairs ? "main effects and interactions of two" : "main effects"));
  return "";
}

/// Shares by drawn weights and drawn fills: draws[k][r] of share k.
std::vector<std::vector<double>> bootstrap(const Table& table, const std::vector<FactorMask>& sets,
                                           const EffectOptions& options) {
  std::vector<std::vector<double>> draws(sets.size() + 2);
  std::mt19937_64 random(options.seed);
  const int affordable = static_cast<int>(work_of_draws / static_cast<double>(table.shape.size()));
  const int replicates = std::clamp(affordable, fewest_draws, std::max(options.replicates, fewest_draws));
  std::vector<double> drawn = table.values;
  for (int r = 0; r < replicates; ++r) {
    const auto weights = draw_weights(table.shape, random);
    if (!table.residuals.empty())
      for (std::size_t cell = 0; cell < drawn.size(); ++cell)
        if (!table.known[cell]) drawn[cell] = table.values[cell] + table.residuals[random() % table.residuals.size()];
    std::vector<double> variances = table.shape.variances(drawn, weights);
    const std::vector<double> correction = corrections(table.shape, weights);
    for (FactorMask mask = 0; mask < variances.size(); ++mask) variances[mask] *= correction[mask];
    const std::vector<double> shares = shares_of(variances, sets, table.repeats);
    for (std::size_t k = 0; k < shares.size(); ++k)
      if (std::isfinite(shares[k])) draws[k].push_back(shares[k]);
  }
  for (auto& draw : draws) std::sort(draw.begin(), draw.end());
  return draws;
}

/// Round-off of a decomposition is neither a share nor the lack of one.
double tidy(double share) {
  return share < round_off ? 0 : share > 1 - round_off ? 1 : share;
}

void set_interval(EffectShare& out, double share, const std::vector<double>& sorted) {
  share = tidy(share);
  out.share = out.low = out.high = share;
  if (sorted.empty()) return;
  const auto at = [&](double p) {
    return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1) + 0.5)];
  };
  out.low = std::min(share, tidy(at(0.025)));
  out.high = std::max(share, tidy(at(0.975)));
}

// Of each set of factors that is told, with its interval.
void add_shares(const std::vector<Factor>& factors, const Table& table, const Active& active,
                const EffectOptions& options, Effects& out) {
  const std::size_t count = active.factors.size();
  const std::vector<FactorMask> sets = told(count);
  const std::vector<double> shares =
      shares_of(table.shape.variances(table.values, table.shape.uniform()), sets, table.repeats);
  const auto draws = bootstrap(table, sets, options);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    std::vector<std::string> members;
    for (std::size_t f = 0; f < count; ++f)
      if (sets[k] >> f & 1) members.push_back(factors[active.factors[f]].name);
    const bool alone = members.size() == 1;
    if (!alone) out.shares.push_back({fmt::format("{}", fmt::join(members, " × "))});
    set_interval(alone ? out.shares[active.factors[k]] : out.shares.back(), shares[k], draws[k]);
  }
  if (count > highest_order) {
    out.shares.push_back({"higher"});
    set_interval(out.shares.back(), shares[sets.size()], draws[sets.size()]);
  }
  if (table.repeats > 0) {
    out.shares.push_back({"repeats"});
    set_interval(out.shares.back(), shares.back(), draws.back());
    out.notes.push_back("cells that the factors do not tell apart differ: their means are taken, the rest is repeats");
  }
}

}  // namespace

Effects effects_of(const std::vector<Factor>& factors, const Values& values, const EffectOptions& options) {
  for (const Factor& factor : factors) {
    if (factor.level.size() != values.size()) throw std::invalid_argument("effects: one level per cell and factor");
    for (const std::size_t l : factor.level)
      if (l >= factor.levels.size()) throw std::invalid_argument("effects: a level that its factor does not have");
  }
  Effects out;
  const auto without_shares = [&](const std::string& reason) {
    out.notes.push_back(reason);
    for (EffectShare& share : out.shares)
      if (share.reason.empty()) share.reason = reason;
    return out;
  };

  std::vector<char> has_value;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto& value : values) {
    has_value.push_back(value && std::isfinite(*value));
    if (has_value.back()) low = std::min(low, *value), high = std::max(high, *value);
  }
  const Active active = find_active(factors, has_value, out);
  if (low > high) return without_shares("no cell has a value");
  if (active.factors.empty()) return without_shares("no factor has two levels with a value");
  if (high - low <= equal * std::max(std::abs(low), std::abs(high)))
    return without_shares("all values are the same to twelve digits");
  out.log = low > 0 && std::log10(high / low) > decades_for_log;
  if (out.log)
    out.notes.push_back(
        fmt::format("the values span {:.1f} decades: shares are of their logarithm", std::log10(high / low)));

  double combinations = 1;
  std::vector<std::size_t> sizes;
  for (const std::size_t k : active.factors) {
    const auto& numbers = active.renumbered[k];
    sizes.push_back(numbers.size() - static_cast<std::size_t>(std::count(numbers.begin(), numbers.end(), npos)));
    combinations *= static_cast<double>(sizes.back());
  }
  if (combinations > largest_table || sizes.size() > most_factors)
    return without_shares(
        fmt::format("{} factors make {:.2g} combinations, too many for a table", sizes.size(), combinations));
  Table table = tabulate(factors, values, has_value, active, sizes, out.log);
  out.combinations = table.shape.size();
  out.missing = out.combinations - static_cast<std::size_t>(table.present);
  if (const std::string reason = complete(table, out); !reason.empty()) return without_shares(reason);

  add_shares(factors, table, active, options, out);
  return out;
}

}  // namespace ricochet
