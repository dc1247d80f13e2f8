#include <ostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/run/compare_studies.hpp"
#include "runners/run/derive.hpp"
#include "runners/store/store.hpp"
#include "runners/table/csv_text.hpp"

namespace ricochet {

int command_compare(const Arguments& arguments, std::ostream& out) {
  const StudyResults a = with_tables(read_store(arguments.operands[0])),
                     b = with_tables(read_store(arguments.operands[1]));
  const StudyComparison found = compare_studies(a, b);
  out << (arguments.table ? table_csv(comparison_table(found)) : comparison_text(found, a, b));
  return exit_done;
}

}  // namespace ricochet
