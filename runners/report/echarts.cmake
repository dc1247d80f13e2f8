# Puts the page's style and script, and the chart library where npm has fetched it, inside ricochet_runners.
# Nothing is downloaded here: `npm ci` in this folder brings the library, and the next build picks it up.
option(RICOCHET_CHARTS "Inline the chart library in reports where node_modules has it" ON)

set(RICOCHET_REPORT_DIR ${CMAKE_CURRENT_LIST_DIR})
set(RICOCHET_ECHARTS ${RICOCHET_REPORT_DIR}/node_modules/echarts/dist/echarts.min.js)
set(RICOCHET_WITH_ECHARTS 0)
set(RICOCHET_ECHARTS_VERSION "")
set(embedded ${RICOCHET_REPORT_DIR}/page.css ${RICOCHET_REPORT_DIR}/page.js ${RICOCHET_REPORT_DIR}/dynamics.js)

# A glob, so that a build notices when the library comes or goes.
file(GLOB found CONFIGURE_DEPENDS ${RICOCHET_ECHARTS})
if(RICOCHET_CHARTS AND found)
  set(RICOCHET_WITH_ECHARTS 1)
  list(APPEND embedded ${RICOCHET_ECHARTS})
  file(READ ${RICOCHET_REPORT_DIR}/node_modules/echarts/package.json package)
  string(JSON RICOCHET_ECHARTS_VERSION GET "${package}" version)
  message(STATUS "Reports: charts by ECharts ${RICOCHET_ECHARTS_VERSION}")
elseif(RICOCHET_CHARTS)
  message(STATUS "Reports: tables only (for charts run `npm ci` in runners/report, then build again)")
else()
  message(STATUS "Reports: tables only (RICOCHET_CHARTS is OFF)")
endif()

set(assets ${CMAKE_BINARY_DIR}/generated/report_assets.cpp)
configure_file(${RICOCHET_REPORT_DIR}/assets.cpp.in ${assets} @ONLY)
set_source_files_properties(${assets} PROPERTIES OBJECT_DEPENDS "${embedded}")
target_sources(ricochet_runners PRIVATE ${assets})
