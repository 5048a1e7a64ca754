#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pixelflex::testing {

/// Loads a model file of these bytes, the first of which says of what kind it is: o OBJ, p PLY, s STL, g glTF, b its
/// binary form, any other OBJ. What comes of it may be a sound scene or a ModelError that names the file; anything else
/// is a bug and leaves as another exception. Returns how many triangles it has; 0: refused.
std::size_t readModel(std::span<const std::uint8_t> bytes);

}  // namespace pixelflex::testing
