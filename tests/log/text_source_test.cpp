// SPDX-License-Identifier: BSD-3-Clause
#include "log/text_source.hpp"

#include <gtest/gtest.h>

#include "log/packed_bytes.hpp"
#include "log/temporary_file.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

std::string ReadAll(TextSource* source, std::size_t block_size = 777) {
  std::string text;
  std::string block(block_size, '\0');
  std::size_t count = block_size;
  while (count == block_size) {
    count = source->Read(block.data(), block.size());
    text.append(block, 0, count);
  }
  return text;
}

std::string SomeText() {
  std::string text;
  for (int i = 0; i < 40000; ++i) text += "line " + std::to_string(i * 7919 % 10007) + "\n";
  return text;
}

TEST(TextSourceTest, ReadsPlainAndPackedByContent) {
  const std::string text = SomeText();
  for (const std::string& content :
       {text, Gzipped(text), Bzip2Packed(text), ZstdPacked(text),
        ZstdPacked(text.substr(0, 1000)) + ZstdPacked(text.substr(1000))}) {
    const TemporaryFile file(".log", content);
    TextSource source(file.path());
    EXPECT_EQ(ReadAll(&source), text);
    EXPECT_FALSE(source.Truncated());
    EXPECT_EQ(source.TrailingBytes(), 0U);
    EXPECT_EQ(source.Progress(), 1.0);
  }
}

TEST(TextSourceTest, ReadsConcatenatedMembers) {
  const TemporaryFile file(".gz",
                           Gzipped("one\n") + Gzipped("") + Gzipped(SomeText()) + Gzipped("end\n"));
  TextSource source(file.path());
  EXPECT_EQ(ReadAll(&source), "one\n" + SomeText() + "end\n");
  EXPECT_FALSE(source.Truncated());
}

TEST(TextSourceTest, IgnoresAndCountsGarbageBehindGzip) {
  for (const std::string& garbage :
       {std::string("x"), std::string(1000, '\0'), std::string(300000, 'y')}) {
    const TemporaryFile file(".gz", Gzipped(SomeText()) + garbage);
    TextSource source(file.path());
    EXPECT_EQ(ReadAll(&source), SomeText());
    EXPECT_FALSE(source.Truncated());
    EXPECT_EQ(source.TrailingBytes(), garbage.size());
  }
}

TEST(TextSourceTest, GivesTheGoodPartOfACutOrDamagedGzip) {
  const std::string text = SomeText();
  const std::string packed = Gzipped(text);
  for (const std::size_t length : {packed.size() / 2, packed.size() - 1, packed.size() - 8}) {
    const TemporaryFile file(".gz", packed.substr(0, length));
    TextSource source(file.path());
    const std::string part = ReadAll(&source);
    EXPECT_GT(part.size(), text.size() / 4);
    EXPECT_EQ(part, text.substr(0, part.size()));
    EXPECT_TRUE(source.Truncated());
  }
  std::string damaged = packed;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x55);
  const TemporaryFile file(".gz", damaged);
  TextSource source(file.path());
  const std::string part = ReadAll(&source);
  EXPECT_EQ(part.substr(0, text.size() / 4), text.substr(0, text.size() / 4));
  EXPECT_TRUE(source.Truncated());
}

TEST(TextSourceTest, RefusesWhatIsNoFile) {
  EXPECT_THROW(TextSource("/no/such/file"), InputError);
  EXPECT_THROW(TextSource("/tmp"), InputError);
  EXPECT_THROW(TextSource("/dev/zero"), InputError);
  const TemporaryFile file(".gz", "plain text\n");
  EXPECT_THROW(TextSource{file.path()}, InputError);
}

}  // namespace
}  // namespace masked_mapper
