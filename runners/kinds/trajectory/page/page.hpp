#pragma once
#include <string>
#include <vector>

#include "runners/report/choices.hpp"
#include "runners/report/kind_page.hpp"

/// \file
/// What a report of kind `trajectory` shows: energies over time and at the end, stops, shocks, orbits, spectra.
namespace ricochet::report {

KindPage trajectory_page();

/// What the energy of each case ends at, told from its start: |E(T)/E(0) − 1|, and whether it was a gain. Then whether
/// nothing but contact changes energies in this study.
Table energy_changes(const Choices& choices);

/// Where places are within their clearances: the finest case of each method, thinned to what a figure shows.
Table orbit_points(const Choices& choices);

/// The cases of each method, finest mesh and step first.
std::vector<Cases> methods_from_finest(const Choices& study);

/// What each stop that has a name gives, a row per measure and a column per stop, as HTML; "" without such stops.
std::string stops_html(const Choices& choices);

/// The largest shocks of the finest case of each method, for a figure.
Table shock_points(const Choices& choices);

/// Between which densities the spectra of all methods are at their finest step and mesh, and what refining still moves
/// them by, for a figure.
Table spectrum_bands(const Choices& choices);

/// Measures with what methods, step and mesh leave open, at most eight rows, for the page that a file keeps. Those that
/// the study observes come first, then others of its stops. "" of a study without contact.
std::string summary_measures_html(const Choices& choices);

}  // namespace ricochet::report
