// NumPy's .npy files, for tests of what reads them.
#pragma once

#include <cstring>
#include <string>
#include <vector>

namespace raytree::test {

/// The bytes of a file that holds `values` in rows of `columns`; by default as the program wants them.
inline std::string npy_file(const std::vector<float>& values, std::size_t columns, const std::string& type = "<f4",
                            const std::string& fortran_order = "False", int version = 1) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + fortran_order + ", 'shape': (" +
                       std::to_string(values.size() / columns) + ", " + std::to_string(columns) + "), }";
  const std::size_t lead = version == 1 ? 10 : 12;
  while ((lead + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  if (version > 1) bytes += std::string(2, '\0');
  bytes += header;
  const std::size_t at = bytes.size();
  bytes.resize(at + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(&bytes[at], values.data(), values.size() * sizeof(float));
  return bytes;
}

}  // namespace raytree::test
