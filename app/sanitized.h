// Whether this build carries AddressSanitizer: g++ says so by a macro, clang by a feature. Its shadow
// memory and quarantine are no memory of the program: the most that something takes cannot be told there.
#pragma once

namespace raytree {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kAddressSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kAddressSanitized = true;
#else
inline constexpr bool kAddressSanitized = false;
#endif
#else
inline constexpr bool kAddressSanitized = false;
#endif

}  // namespace raytree
