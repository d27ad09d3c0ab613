// Cages that tests of subdivision share: benchmarks/samples/cages.h.
#pragma once

#include "benchmarks/samples/cages.h"
#include "tests/degrees_between.h"

namespace raytree::test {
using namespace samples;
}
