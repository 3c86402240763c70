// Many pictures on one page.
#pragma once

#include <span>
#include <string>

#include "render/image/image.h"

namespace pneuma::render {

/// The picture at a smaller size: each pixel is the mean of what it covers. Throws
/// std::invalid_argument unless 1 <= width <= image.width, and so for the height.
Image downscale(const Image& image, int width, int height);

/// A page at most `width` pixels wide with the pictures row by row, each made to fit its cell and
/// centred in it, never enlarged: cells are as wide as the page allows, but no wider than the
/// widest picture. They have the shape of the first picture; those without a picture stay empty.
/// Below each picture is its caption, if there are any, one for each, as wide as the cell. Throws
/// std::invalid_argument without pictures, with more than columns x rows of them, or when
/// the page is too narrow for its columns.
Image contact_sheet(std::span<const Image> images, int columns, int rows, int width = 1280,
                    std::span<const std::string> captions = {});

}  // namespace pneuma::render
