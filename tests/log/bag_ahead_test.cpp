// SPDX-License-Identifier: BSD-3-Clause
#include "log/bag_ahead.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "log/cloud_bytes.hpp"

namespace masked_mapper {
namespace {

/// Of one connection.
class FakeBag : public RosBag {
 public:
  FakeBag(std::uint32_t connection, const std::string& topic) {
    connections_[connection].topic = topic;
  }
  const std::map<std::uint32_t, BagConnection>& Connections() const override {
    return connections_;
  }
  bool IsIndexed() const override { return true; }

 private:
  std::map<std::uint32_t, BagConnection> connections_;
};

/// Message i holds i bytes of i; the bag is damaged behind the tenth, and may throw at its end.
class CountingBag final : public FakeBag {
 public:
  explicit CountingBag(int messages, bool throws = false)
      : FakeBag(3, "/count"), messages_(messages), throws_(throws) {}
  std::optional<BagMessage> Next() override {
    if (next_ == messages_ && throws_) throw std::runtime_error("the disk is gone");
    if (next_ == messages_) return std::nullopt;
    bytes_.assign(static_cast<std::size_t>(next_), static_cast<unsigned char>(next_));
    BagMessage message;
    message.connection = 3;
    message.time = next_++;
    message.data = bytes_.data();
    message.size = bytes_.size();
    return message;
  }
  void Rewind() override { next_ = 0; }
  bool Truncated() const override { return next_ == messages_; }
  std::uint64_t Damaged() const override { return next_ > 10 ? 1 : 0; }
  std::string FirstDamage() const override { return "the eleventh"; }
  double Progress() const override { return static_cast<double>(next_) / messages_; }

 private:
  int messages_;
  bool throws_;
  int next_ = 0;
  std::vector<unsigned char> bytes_;
};

int CountAll(BagAhead* ahead) {
  int count = 0;
  while (const std::optional<BagMessage> message = ahead->Next()) {
    EXPECT_EQ(message->time, count);
    EXPECT_EQ(message->connection, 3U);
    EXPECT_EQ(message->size, static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < message->size; ++i) {
      EXPECT_EQ(message->data[i], static_cast<unsigned char>(count));
    }
    ++count;
  }
  return count;
}

TEST(BagAheadTest, GivesTheMessagesOfTheBagAndItsState) {
  CountingBag bag(3000);
  BagAhead ahead(&bag);
  EXPECT_EQ(ahead.Connections().at(3).topic, "/count");
  EXPECT_FALSE(ahead.Truncated());
  for (int pass = 0; pass < 2; ++pass) {
    EXPECT_EQ(CountAll(&ahead), 3000);
    EXPECT_FALSE(ahead.Next());
    EXPECT_TRUE(ahead.Truncated());
    EXPECT_EQ(ahead.Damaged(), 1U);
    EXPECT_EQ(ahead.FirstDamage(), "the eleventh");
    EXPECT_EQ(ahead.Progress(), 1.0);
    ahead.Rewind();
  }
}

/// A cloud of one point more in each message, but one of them is cut off.
class CloudBag final : public FakeBag {
 public:
  explicit CloudBag(std::size_t messages) : FakeBag(5, "/points"), messages_(messages) {}
  std::optional<BagMessage> Next() override {
    if (next_ == messages_) return std::nullopt;
    bytes_ = CloudOf({{"x", 0}, {"y", 4}, {"z", 8}}, 12,
                     std::vector<std::vector<double>>(++next_, {1.0, 2.0, 3.0}))
                 .Ros1();
    if (next_ == kCut) bytes_.pop_back();
    BagMessage message;
    message.connection = 5;
    message.data = reinterpret_cast<const unsigned char*>(bytes_.data());
    message.size = bytes_.size();
    return message;
  }
  void Rewind() override { next_ = 0; }
  bool Truncated() const override { return false; }
  std::uint64_t Damaged() const override { return 0; }
  double Progress() const override { return 0.0; }

  static constexpr std::size_t kCut = 7;

 private:
  std::size_t messages_;
  std::size_t next_ = 0;
  std::string bytes_;
};

TEST(BagAheadTest, ParsesCloudsAndLeavesTheBytesOfThoseThatAreNone) {
  CloudBag bag(100);
  BagAhead ahead(&bag, [](std::uint32_t connection) { return connection == 5; });
  for (std::size_t points = 1; points <= 100; ++points) {
    const std::optional<BagMessage> message = ahead.Next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->cloud == nullptr, points == CloudBag::kCut);
    if (message->cloud) {
      EXPECT_EQ(message->cloud->points.size(), points);
    } else {
      EXPECT_NE(FaultOfPointCloud(message->data, message->size), "");
    }
  }
  EXPECT_FALSE(ahead.Next());
}

TEST(BagAheadTest, MayBeLeftInTheMiddle) {
  CountingBag bag(5000);
  BagAhead ahead(&bag);
  EXPECT_TRUE(ahead.Next());
  ahead.Rewind();
  EXPECT_EQ(ahead.Next()->time, 0.0);
}

TEST(BagAheadTest, ThrowsWhatTheBagThrows) {
  CountingBag bag(5, true);
  BagAhead ahead(&bag);
  EXPECT_THROW(CountAll(&ahead), std::runtime_error);
}

}  // namespace
}  // namespace masked_mapper
