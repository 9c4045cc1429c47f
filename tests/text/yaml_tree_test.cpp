// SPDX-License-Identifier: BSD-3-Clause
#include "masked_mapper/text/yaml_tree.hpp"

#include <gtest/gtest.h>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

TEST(YamlTree, KnowsItsLines) {
  const YamlTree tree = ParseYaml("a.yaml", "one: 1\ntwo:\n  - x\n  - {three: y}\n");
  ASSERT_EQ(tree.kind, YamlTree::Kind::kSection);
  ASSERT_EQ(tree.entries.size(), 2U);
  EXPECT_EQ(tree.entries[0].key, "one");
  EXPECT_EQ(tree.entries[0].tree.value, "1");
  const YamlTree& list = tree.entries[1].tree;
  ASSERT_EQ(list.kind, YamlTree::Kind::kList);
  ASSERT_EQ(list.list.size(), 2U);
  EXPECT_EQ(list.list[0].value, "x");
  EXPECT_EQ(list.list[0].line, 3U);
  EXPECT_EQ(list.list[1].entries[0].key, "three");
  EXPECT_EQ(list.list[1].entries[0].line, 4U);
}

TEST(YamlTree, NothingIsEmpty) {
  EXPECT_EQ(ParseYaml("a.yaml", "").kind, YamlTree::Kind::kEmpty);
  EXPECT_EQ(ParseYaml("a.yaml", "# a word\n").kind, YamlTree::Kind::kEmpty);
}

TEST(YamlTree, SaysWhereItIsNotValid) {
  for (const char* text : {"a: [1\n", "a: 1\n---\nb: 2\n", "? [x]\n: 1\n"}) {
    try {
      ParseYaml("a.yaml", text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("a.yaml", 0), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace masked_mapper
