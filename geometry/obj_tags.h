// OpenSubdiv's tags in OBJ text, `t NAME I/F/S` with I integers, F numbers and S words after it: creases, corners,
// holes and rules of a subdivision cage. Indices count from 0 over the whole file, unlike those of `f`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "geometry/subdivision_cage.h"

namespace raytree {

/// How often something stands in the text, and where first.
struct ObjTally {
  std::int64_t count = 0;
  const char* first = nullptr;
  void add(const char* place) {
    if (count++ == 0) first = place;
  }
  void add(const ObjTally& later) {
    if (count == 0) first = later.first;
    count += later.count;
  }
};

/// What tags may name.
struct ObjTagLimits {
  std::size_t vertices = 0, faces = 0;  ///< of the file
};

struct ObjTagFindings {
  SubdivisionRules rules;
  bool any = false;         ///< a tag that was understood
  ObjTally edits, unknown;  ///< hierarchical edits, and names that OpenSubdiv's own reader does not know
};

/// Reads one statement, [p, end) being what follows the `t`; `source` is its place for tallies. False, and what is
/// wrong in `error`, if a known tag cannot be read, names what is not there or has a sharpness below 0.
bool scan_obj_tag(const char* p, const char* end, const ObjTagLimits& limits, const char* source,
                  ObjTagFindings& findings, std::string& error);

}  // namespace raytree
