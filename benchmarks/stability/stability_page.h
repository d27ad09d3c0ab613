// The page of a run of the stability suite: verdicts counted on top, then each failure beside its remedy.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/stability/stability.h"

namespace raytree::benchmarks {

/// A part of the page beside the cases, reached from the list on top.
struct PageSection {
  std::string id;     ///< for links: "maps"
  std::string title;  ///< text
  std::string html;   ///< below the title; with cards of its own
};

/// One file that needs no network (report_page.h). `more` stands between the counts and the cases.
std::string stability_page(const StabilityReport& report, const std::vector<PageSection>& more = {});

}  // namespace raytree::benchmarks
