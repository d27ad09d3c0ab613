// Labels in pictures: small letters of 5 x 9 dots, drawn large enough to read. Capitals come out small.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace raytree::app {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 9;  ///< dots; two rows hang below the base line
inline constexpr int kGlyphAdvance = kGlyphWidth + 1;    ///< from one letter to the next
inline constexpr char kEllipsis = '\x85';                ///< the letter of three dots: a name goes on
/// `text`, or its beginning with kEllipsis behind it, in at most `letters` letters; empty where that says nothing.
std::string shortened(const std::string& text, std::size_t letters);

/// Whether the dot in this column and row of a letter is set; a letter that is not known is a box.
bool glyph_dot(char letter, int column, int row);

/// Calls dot(column, row) for each dot of a line of text that is set, counted from the line's upper left corner.
template <class Dot>
void for_each_dot(std::string_view text, Dot&& dot) {
  for (std::size_t i = 0; i < text.size(); ++i)
    for (int row = 0; row < kGlyphHeight; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph_dot(text[i], column, row)) dot(static_cast<int>(i) * kGlyphAdvance + column, row);
}

}  // namespace raytree::app
