#pragma once
#include <string>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/kinds/sweep/march_point.hpp"
#include "runners/store/record.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

/// The table of this name that a case left. Throws PointRefused where it has none, with what became of it.
const Table& stored_table(const CaseRecord& record, const std::string& name);

/// Samples as lines of CSV: t, tip_displacement, tip_velocity.
class SamplePrinter {
 public:
  explicit SamplePrinter(std::ostream& out);
  void operator()(const PointSample& sample);

 private:
  std::ostream& out_;
};

/// --periods and --samples, or what stands for them.
SampleCount wanted_count(const PointRequest& asked);

/// "; 3 of 4 strobes as stored: the results are of another build of the program".
std::string comparison_text(std::size_t equal, std::size_t compared);

/// "0.1, 0.2, 0.3": the values nearest to a wanted one.
std::string nearest_values(const std::vector<double>& values, double wanted);
/// Whether a stored value is the one that was written in digits.
bool is_value(double stored, double wanted);

}  // namespace ricochet
