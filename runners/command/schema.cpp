#include <ostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/study_schema.hpp"

namespace ricochet {

int command_schema(const Arguments& arguments, std::ostream& out) {
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  catalogue.open_all(registry);
  out << study_schema(registry).dump() << "\n";
  return exit_done;
}

}  // namespace ricochet
