# What a report's page is made of becomes part of the program: the files of io/report/, and JavaScript libraries from the
# system. Sets report_assets_source, which is compiled into the library and takes the files in as they are.
set(GRANDAMP_JAVASCRIPT /usr/share/javascript CACHE PATH "Where three, dygraphs and chart.js are (Debian: libjs-three libjs-dygraphs libjs-chart.js)")

set(report_assets "")
foreach(file page.html page.css base.js histories.js charts.js spheres.js granules.js page.js licences.txt)
  list(APPEND report_assets "${file}=${CMAKE_CURRENT_LIST_DIR}/${file}")
endforeach()
list(APPEND report_assets
  "three.js=${GRANDAMP_JAVASCRIPT}/three/three.min.js"
  "orbit_controls.js=${GRANDAMP_JAVASCRIPT}/three/examples/js/controls/OrbitControls.js"
  "dygraph.js=${GRANDAMP_JAVASCRIPT}/dygraphs/dygraph.min.js"
  "dygraph.css=${GRANDAMP_JAVASCRIPT}/dygraphs/dygraph.min.css"
  "chart.js=${GRANDAMP_JAVASCRIPT}/chart.js/chart.min.js")

set(report_incbin "")
set(report_declarations "")
set(report_entries "")
set(report_files "")
set(report_missing "")
foreach(asset ${report_assets})
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${asset}")
  set(name ${CMAKE_MATCH_1})
  set(file ${CMAKE_MATCH_2})
  string(MAKE_C_IDENTIFIER "grandamp_asset_${name}" symbol)
  if(NOT EXISTS "${file}")
    string(APPEND report_missing "\n  ${file}")
  endif()
  list(APPEND report_files "${file}")
  string(APPEND report_incbin ".hidden ${symbol}\\n.global ${symbol}\\n${symbol}: .incbin \\\"${file}\\\"\\n.hidden ${symbol}_end\\n.global ${symbol}_end\\n${symbol}_end: .byte 0\\n")
  string(APPEND report_declarations "extern const char ${symbol}[], ${symbol}_end[];\n")
  string(APPEND report_entries "    if (name == \"${name}\") return {${symbol}, ${symbol}_end};\n")
endforeach()
if(report_missing)
  message(FATAL_ERROR "`grandamp report` embeds JavaScript libraries into its pages; these files are missing:${report_missing}\n"
    "On Debian: apt-get install libjs-three libjs-dygraphs libjs-chart.js. Elsewhere say where they are: -DGRANDAMP_JAVASCRIPT=FOLDER")
endif()

set(report_assets_source ${PROJECT_BINARY_DIR}/report_assets.cpp)
file(CONFIGURE OUTPUT ${report_assets_source} @ONLY CONTENT [[
// Made by io/report/assets.cmake.
#include "io/report_assets.hpp"

#include <stdexcept>
#include <string>

asm(".pushsection .rodata\n@report_incbin@.popsection\n");

extern "C" {
@report_declarations@}

namespace grandamp::report {

std::string_view asset(std::string_view name) {
@report_entries@    throw std::out_of_range(std::string(name));
}

} // namespace grandamp::report
]])
set_source_files_properties(${report_assets_source} PROPERTIES OBJECT_DEPENDS "${report_files}")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${report_files})
