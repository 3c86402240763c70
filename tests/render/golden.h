// Pictures compared with committed ones.
#pragma once

#include <string>

#include "render/image/image.h"

namespace pneuma::render {

/// Fails the test unless `image` looks like tests/golden/NAME.png. A failure writes
/// NAME.actual.png, NAME.expected.png and NAME.difference.png into a folder of the build and says
/// where. With PNEUMA_UPDATE_GOLDEN=1 in the environment the committed picture is replaced instead.
void expect_golden(const std::string& name, const Image& image);

}  // namespace pneuma::render
