# Puts the files of plugins/examples inside ricochet_runners: `ricochet new` makes its copies of them.
set(folder ${CMAKE_SOURCE_DIR}/plugins/examples)
# A glob, so that a build notices when a file comes or goes.
file(GLOB files CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*/*)
set(RICOCHET_EXAMPLES_EMBEDDED "")
set(RICOCHET_EXAMPLES_LISTED "")
set(embedded "")
foreach(file ${files})
  get_filename_component(role ${file} DIRECTORY)
  get_filename_component(name ${file} NAME)
  string(MAKE_C_IDENTIFIER "ricochet_example_${file}" symbol)
  string(APPEND RICOCHET_EXAMPLES_EMBEDDED "RICOCHET_EMBED(${symbol}, \"${folder}/${file}\")\n")
  string(APPEND RICOCHET_EXAMPLES_LISTED
    "      ExampleFile{\"${role}\", \"${name}\", between(${symbol}_begin, ${symbol}_end)},\n")
  list(APPEND embedded ${folder}/${file})
endforeach()

set(examples ${CMAKE_BINARY_DIR}/generated/examples.cpp)
configure_file(${CMAKE_CURRENT_LIST_DIR}/examples.cpp.in ${examples} @ONLY)
set_source_files_properties(${examples} PROPERTIES OBJECT_DEPENDS "${embedded}")
target_sources(ricochet_runners PRIVATE ${examples})
