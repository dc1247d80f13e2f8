#pragma once
#include <string>
#include <string_view>

#include "runners/store/record.hpp"

namespace ricochet::synthetic {

/// Results with the tables that their kind's page derives, as a run leaves them.
StudyResults with_page_tables(StudyResults results);

/// Their page.
std::string rendered(const StudyResults& results, std::string_view library, std::string_view version);

}  // namespace ricochet::synthetic
