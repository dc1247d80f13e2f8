# Puts the page's style, scripts and templates, and the chart library where npm has fetched it, inside ricochet_runners.
# Nothing is downloaded here: `npm ci` in this folder brings the library, and the next build picks it up.
option(RICOCHET_CHARTS "Inline the chart library in reports where node_modules has it" ON)

set(report_dir ${CMAKE_CURRENT_LIST_DIR})
set(echarts ${report_dir}/node_modules/echarts/dist/echarts.min.js)
set(RICOCHET_ECHARTS_VERSION "")
file(GLOB embedded CONFIGURE_DEPENDS ${report_dir}/page.css ${report_dir}/script/*.js ${report_dir}/figures/*.js
  ${report_dir}/templates/*.html)

# A glob, so that a build notices when the library comes or goes.
file(GLOB found CONFIGURE_DEPENDS ${echarts})
if(RICOCHET_CHARTS AND found)
  list(APPEND embedded ${echarts})
  file(READ ${report_dir}/node_modules/echarts/package.json package)
  string(JSON RICOCHET_ECHARTS_VERSION GET "${package}" version)
  message(STATUS "Reports: charts by ECharts ${RICOCHET_ECHARTS_VERSION}")
elseif(RICOCHET_CHARTS)
  message(STATUS "Reports: tables only (for charts run `npm ci` in runners/report, then build again)")
else()
  message(STATUS "Reports: tables only (RICOCHET_CHARTS is OFF)")
endif()

set(RICOCHET_EMBEDDED "")
set(RICOCHET_EMBEDDED_NAMES "")
foreach(file ${embedded})
  file(RELATIVE_PATH name ${report_dir} ${file})
  string(REGEX REPLACE "^node_modules/.*/" "" name ${name})
  string(MAKE_C_IDENTIFIER "ricochet_report_${name}" symbol)
  string(APPEND RICOCHET_EMBEDDED "RICOCHET_EMBED(${symbol}, \"${file}\")\n")
  string(APPEND RICOCHET_EMBEDDED_NAMES "    {\"${name}\", ${symbol}_begin, ${symbol}_end},\n")
endforeach()
set(assets ${CMAKE_BINARY_DIR}/generated/report_assets.cpp)
configure_file(${report_dir}/assets.cpp.in ${assets} @ONLY)
set_source_files_properties(${assets} PROPERTIES OBJECT_DEPENDS "${embedded}")
target_sources(ricochet_runners PRIVATE ${assets})
