// What both modules need at their border: calls that let no exception out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>

#include "renderer/image_io/image_io.h"

namespace raytree::image_io {

/// Runs `work`; 1, or 0 after handing what it threw to `error`.
template <class Work>
int guarded(const Work& work, RaytreeBytesSink error, void* context) {
  const auto report = [&](std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    error(context, text.data(), text.size());
  };
  try {
    work();
    return 1;
  } catch (const std::bad_alloc&) {
    report("not enough memory");
  } catch (const std::exception& problem) {
    report(problem.what());
  } catch (...) {
    report("an error of unknown kind");
  }
  return 0;
}

/// Bytes of the file under way, to the program. Throws where it stops the encoder.
inline void hand_over(RaytreeFileSink file, void* context, std::uint64_t offset, const void* bytes, std::size_t size) {
  if (file(context, offset, bytes, size) == 0) throw std::runtime_error("the file was not taken");
}

}  // namespace raytree::image_io
