// SPDX-License-Identifier: BSD-3-Clause
#include "octomap_file.hpp"

// OctoMap prints from its headers in debug builds unless told not to.
#ifndef OCTOMAP_NODEBUGOUT
#define OCTOMAP_NODEBUGOUT
#endif
#include <octomap/octomap.h>

#include <ostream>
#include <streambuf>

#include "masked_mapper/text/number_text.hpp"
#include "output_file.hpp"

namespace masked_mapper {
namespace {

// OctoMap writes to a stream, bytes at a time, and looks at no error; these do not get lost.
class CheckedStream : public std::streambuf {
 public:
  explicit CheckedStream(OutputFile* file) : file_(file) {}

 protected:
  int_type overflow(int_type byte) override {
    const char character = traits_type::to_char_type(byte);
    file_->Write({&character, 1});
    return byte;
  }
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    file_->Write({bytes, static_cast<std::size_t>(count)});
    return count;
  }

 private:
  OutputFile* file_;
};

}  // namespace

void WriteOctomap(const octomap::OcTree& tree, const std::filesystem::path& path) {
  OutputFile file(path);
  CheckedStream buffer(&file);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);  // hands on what Write throws
  // OctoMap's own writeBinary says "done" on the terminal.
  stream << "# Octomap OcTree binary file\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
         << ExactText(tree.getResolution()) << "\ndata\n";
  if (tree.size() > 0) tree.writeBinaryData(stream);
  file.Close();
}

}  // namespace masked_mapper
