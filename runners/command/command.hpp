#pragma once
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "runners/run/exit_code.hpp"

namespace ricochet {

class WorkerHost;

/// The machines that workers may be started on, this one first, each with so many workers; 0: as many as it has
/// processors.
using FindHosts = std::function<std::vector<std::shared_ptr<WorkerHost>>(int jobs)>;

/// The `ricochet` command: `arguments` without the program's name. Errors go to `err`, each as one clear message; no
/// exception leaves. `hosts`: where a run has more machines than this one.
int run_command(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
                const FindHosts& hosts = {});

}  // namespace ricochet
