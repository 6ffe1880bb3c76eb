// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "perception/camera/picture.hpp"

namespace adit::bench {

/// The pictures (JPEG, and PPM of 8 bits) of a folder, by their names, at most `most`. Throws
/// std::runtime_error when one cannot be read, or there is none.
std::vector<perception::Picture> frames_of(const std::string& folder, std::size_t most);

/// The names of their files.
std::vector<std::string> frame_names(const std::string& folder, std::size_t most);

/// Made-up pictures of 1280 x 720 pixels: a textured background that moves by `shift` pixels from one to the
/// next, and an object that moves before it.
std::vector<perception::Picture> made_up_frames(std::size_t count, std::uint32_t shift);

}  // namespace adit::bench
