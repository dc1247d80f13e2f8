#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "runners/asks/answer_asks.hpp"
#include "tests/runners/answers/small_studies.hpp"

/// \file
/// Tables of cases whose truth is known: values with an error in the step, draws that scatter, cases that are missing.
namespace ricochet::asks {

/// How the cases of a made study come about.
struct Made {
  std::vector<synthetic::Choice> choices;
  std::vector<double> steps = {4e-3, 2e-3, 1e-3, 5e-4};
  std::function<double(const std::vector<std::size_t>& at)> truth;
  double error = 0, order = 1, second = 0;  ///< value = truth (1 + error hᵖ/h₁ᵖ + second h²ᵖ/h₁²ᵖ)
  double scatter = 0;                       ///< of draws, as a share of the truth
  double chance = 0;                        ///< likewise, of each step with its own
  std::string measure = "impulse";

  StudyResults results() const {
    return synthetic::full_factorial(
        choices, steps,
        [&](const std::vector<std::size_t>& at, double h) {
          const double part = std::pow(h / steps.front(), order);
          // One draw for all steps of a case and for all methods: its seed's.
          double draw = 0;
          for (std::size_t k = 0; k < choices.size(); ++k)
            if (choices[k].column == seed_axis) {
              std::mt19937 of_seed(static_cast<unsigned>(at[k]) * 7919 + first_seed);
              draw = scatter * std::normal_distribution<double>()(of_seed);
            }
          std::size_t number = static_cast<std::size_t>(first_seed) + std::hash<double>()(h);
          for (const std::size_t level : at) number = 31 * number + level;
          std::mt19937 of_case(static_cast<unsigned>(number));
          const double own = chance > 0 ? chance * std::normal_distribution<double>()(of_case) : 0;
          return truth(at) * (1 + error * part + second * part * part + draw + own);
        },
        measure);
  }
  unsigned first_seed = 1;
};

/// What a made study answers to one ask.
inline Answered answer_of(const StudyResults& results, const Json& ask) {
  const Choices choices(results);
  return answer_asks({ask_of(ask, 1)}, Evidence(choices), {}).all.front().second;
}

/// How many random tables a law is tried on.
inline constexpr int tries = 2000;

inline double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Methods with random limits near each other, and random errors in the step.
inline Made random_methods(std::mt19937& random, std::size_t levels) {
  Made made;
  synthetic::Choice mass{"mass", {}};
  std::vector<double> truths;
  for (std::size_t k = 0; k < levels; ++k) {
    mass.levels.push_back("m" + std::to_string(k));
    truths.push_back(uniform(random, 0.5, 1.5));
  }
  made.choices = {mass};
  const std::size_t steps = 3 + random() % 3;
  made.steps.clear();
  for (std::size_t k = 0; k < steps; ++k) made.steps.push_back(4e-3 * std::pow(0.5, static_cast<double>(k)));
  made.truth = [truths](const std::vector<std::size_t>& at) { return truths[at[0]]; };
  // Errors that one term rules: what three sizes can show.
  made.error = uniform(random, -0.3, 0.3);
  made.order = uniform(random, 0.7, 2.5);
  made.second = uniform(random, -0.1, 0.1) * made.error;
  return made;
}

/// Values of two methods at four halved steps.
inline StudyResults two_methods(const std::vector<double>& first, const std::vector<double>& second) {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  return synthetic::full_factorial(
      made.choices, {8e-3, 4e-3, 2e-3, 1e-3},
      [&](const std::vector<std::size_t>& at, double h) {
        return (at[0] == 0 ? first : second)[static_cast<std::size_t>(std::lround(std::log2(8e-3 / h)))];
      },
      "impulse");
}

}  // namespace ricochet::asks
