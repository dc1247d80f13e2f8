#pragma once
#include <ricochet/measure/attractors/attractors.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/orbit_rows.hpp"

namespace ricochet {

/// Points of a cell that are kept, at most.
constexpr int longest_cell_section = 64;

/// What the orbit of one cell of a grid ended in.
struct CellEnd {
  Regime regime = Regime::failed;
  int period = 0;                     ///< 0: nothing repeats
  long long periods = 0;              ///< marched, transient and kept
  std::string status, reason;         ///< done, refused, diverged, failed
  std::vector<SectionPoint> section;  ///< strobed: one period of what repeats, else the last points
  std::vector<double> displacements;  ///< of the same strobes, without the sawtooth of single steps
};

/// The end of a finished orbit; its readings are judged here and may then be dropped.
CellEnd cell_end(const Orbit& orbit, const SectionPlan& plan);
CellEnd refused_end(const std::string& sentence);

/// Ends as bytes and back, bit for bit. Bytes that to_bytes() did not write throw std::runtime_error.
std::string to_bytes(const std::vector<CellEnd>& ends);
std::vector<CellEnd> cell_ends(const std::string& bytes);

/// Tells apart what cells end in, as they come: ends with equal labels are alike.
///
/// Periodic ones are alike when they have one period and, at some shift of whole forcing periods, every strobed point
/// of one is within 1e-3 of the other's (in units of SectionPlan::scale and ω·scale, without the sawtooth). A motion
/// and its mirror image are two ends. Motions without contact are one. What does not repeat is alike in one class
/// where the Wasserstein-1 distance of the sections is at most 1.5 times what a run is from itself (see
/// measure/point_clouds.hpp); undecided and stopped ones are alike by their status.
class EndLabels {
 public:
  explicit EndLabels(const SectionPlan& plan) : plan_(plan) {}
  int label(const CellEnd& end);

 private:
  struct Known {
    CellEnd end;
    SettledSection section;
  };
  SettledSection settled(const CellEnd& end) const;
  bool same_cycle(const CellEnd& a, const CellEnd& b) const;

  SectionPlan plan_;
  std::vector<Known> known_;
};

}  // namespace ricochet
