#pragma once

#include "lamella/io/image_files.h"

namespace lamella::io::detail {

/// Radiance's RGBE pictures, run-length encoded or not, in the usual orientation (-Y height +X width). [Ward91]
LightImage parse_radiance(std::string_view contents, const std::string& name);

/// @throws InputError  damaged, or built without OpenEXR
LightImage parse_exr(std::string_view contents, const std::string& name);

inline constexpr std::size_t kMostPixels = std::size_t{1} << 28;

}  // namespace lamella::io::detail
