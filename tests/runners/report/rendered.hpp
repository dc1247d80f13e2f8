#pragma once
#include <string>

#include "runners/store/record.hpp"

namespace ricochet::synthetic {

/// Results with the tables that their kind's page derives, as a run leaves them.
StudyResults with_page_tables(StudyResults results);

/// Their page.
std::string rendered(const StudyResults& results);

}  // namespace ricochet::synthetic
