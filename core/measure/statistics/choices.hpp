#pragma once
#include <string>
#include <vector>

/// \file
/// Which choice of a study tells its cases apart.
namespace ricochet {

/// One axis of a study: the level of each case, in words ("" where the case has none).
struct ChoiceAxis {
  std::string name;
  std::vector<std::string> levels;
};

/// Share of the differences between cases that an axis accounts for: with p_k the share of cases that carry label k,
/// G = 1 − Σp_k² (Gini), and G_l the same among the cases of level l, (G − Σ_l n_l G_l / n)/G. 0 where all labels
/// agree. For two labels it is the η² of a one-way analysis of variance. (Goodman and Kruskal 1954, τ.)
double explained_share(const std::vector<int>& labels, const std::vector<std::string>& levels);

/// The axis that separates the labels best.
struct DecidingChoice {
  std::string name;   ///< "time.beta", or "time.beta × mass" where one alone leaves a fifth or more; "" without any
  double share = 0;   ///< explained_share
  double second = 0;  ///< of the next best axis that is no relabelling of it
  std::vector<std::size_t> axes{};  ///< indices of the one or two axes
};

/// Axes are ranked by their share s corrected for their number of levels L among n cases, 1 − (1 − s)(n − 1)/(n − L).
/// An axis that gives each case a level of its own explains anything: its corrected share is 0. Where no corrected
/// share reaches one half, axes are ranked by s. Of equals the one with fewer levels counts, then the first. Two axes
/// together are named where none alone reaches 0.8 and they gain 0.2 or more, corrected in the same way.
DecidingChoice deciding_choice(const std::vector<int>& labels, const std::vector<ChoiceAxis>& axes);

}  // namespace ricochet
