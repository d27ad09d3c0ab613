#include "benchmarks/stability/stability_case.h"
namespace raytree::benchmarks {
std::vector<StabilityCase> curved_cases() { return {}; }
}
