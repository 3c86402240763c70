// The files of app/export/replay/page, which CMake puts into the program.
#pragma once

#include <array>
#include <string_view>

namespace pneuma::app {

extern const std::string_view
    page_template;  // with {{title}}, {{style}}, {{header}}, {{data}}, {{script}}
extern const std::string_view page_style;
extern const std::array<std::string_view, 13> page_scripts;

}  // namespace pneuma::app
