// SPDX-License-Identifier: BSD-3-Clause
#include "sorted_bag.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct Entry {
  double time = 0.0;
  std::uint32_t connection = 0;
  MessageEncoding encoding = MessageEncoding::kRos1;
  std::uint64_t begin = 0;  ///< of the bytes in their run
  std::uint64_t size = 0;
};

}  // namespace

/// One temporary file without a name for all runs.
class SortedBag::File {
 public:
  File() : file_(std::tmpfile()) {
    if (file_ == nullptr) Fail();
  }
  ~File() { std::fclose(file_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::uint64_t size() const { return size_; }
  void Append(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, file_) != count) Fail();
    size_ += count;
  }
  void ReadAt(std::uint64_t position, void* bytes, std::size_t count) {
    if (count == 0) return;
    if (::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0 ||
        std::fread(bytes, 1, count, file_) != count) {
      Fail();
    }
  }

 private:
  [[noreturn]] static void Fail() {
    throw InputError(std::string("messages out of order are sorted in a temporary file, which "
                                 "failed: ") +
                     std::strerror(errno));
  }
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

/// A part of the file whose messages stand in order: their bytes, and behind them their entries.
class SortedBag::Run {
 public:
  Run(const std::vector<unsigned char>& bytes, std::vector<Entry> entries, File* file)
      : file_(file), begin_(file->size()), count_(entries.size()) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.time < b.time; });
    // The bytes in the order of their time, so that a run is read from one end to the other.
    for (Entry& entry : entries) {
      const std::uint64_t at = file->size() - begin_;
      file->Append(bytes.data() + entry.begin, entry.size);
      entry.begin = at;
    }
    entries_ = file->size();
    file->Append(entries.data(), entries.size() * sizeof(Entry));
  }

  void Rewind() {
    next_ = 0;
    ahead_.clear();
    ahead_begin_ = 0;
  }
  bool HasNext() const { return next_ < count_; }
  const Entry& Front() {
    if (next_ >= ahead_begin_ + ahead_.size() || next_ < ahead_begin_) {
      constexpr std::size_t kAhead = 1024;
      ahead_.resize(std::min(kAhead, count_ - next_));
      ahead_begin_ = next_;
      file_->ReadAt(entries_ + next_ * sizeof(Entry), ahead_.data(), ahead_.size() * sizeof(Entry));
    }
    return ahead_[next_ - ahead_begin_];
  }
  BagMessage Take() {
    const Entry& entry = Front();
    bytes_.resize(entry.size);
    file_->ReadAt(begin_ + entry.begin, bytes_.data(), bytes_.size());
    ++next_;
    return {entry.connection, entry.time, bytes_.data(), bytes_.size(), entry.encoding};
  }

 private:
  File* file_;
  std::uint64_t begin_ = 0;
  std::uint64_t entries_ = 0;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  std::vector<Entry> ahead_;
  std::size_t ahead_begin_ = 0;
  std::vector<unsigned char> bytes_;
};

SortedBag::SortedBag(std::unique_ptr<RosBag> bag,
                     const std::function<bool(std::uint32_t)>& is_wanted, std::size_t run_bytes)
    : BagAroundBag(std::move(bag)), file_(std::make_unique<File>()) {
  std::vector<unsigned char> bytes;
  std::vector<Entry> entries;
  const auto close_run = [&] {
    if (entries.empty()) return;
    messages_ += entries.size();
    runs_.push_back(std::make_unique<Run>(bytes, std::exchange(entries, {}), file_.get()));
    bytes.clear();
  };
  while (const std::optional<BagMessage> message = this->bag().Next()) {
    const std::size_t size = is_wanted(message->connection) ? message->size : 0;
    entries.push_back({message->time, message->connection, message->encoding, bytes.size(), size});
    if (size > 0) bytes.insert(bytes.end(), message->data, message->data + size);
    if (bytes.size() + entries.size() * sizeof(Entry) >= run_bytes) close_run();
  }
  close_run();
  Rewind();
}

SortedBag::~SortedBag() = default;

void SortedBag::Rewind() {
  open_runs_.clear();
  given_ = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    runs_[i]->Rewind();
    open_runs_.push_back(i);
  }
}

std::optional<BagMessage> SortedBag::Next() {
  // Few runs, each of many megabytes: the earliest is found by looking at all.
  const auto earliest = std::min_element(
      open_runs_.begin(), open_runs_.end(),
      [this](auto a, auto b) { return runs_[a]->Front().time < runs_[b]->Front().time; });
  if (earliest == open_runs_.end()) return std::nullopt;
  Run& run = *runs_[*earliest];
  ++given_;
  const BagMessage message = run.Take();
  if (!run.HasNext()) open_runs_.erase(earliest);
  return message;
}

double SortedBag::Progress() const {
  return messages_ == 0 ? 1.0 : static_cast<double>(given_) / static_cast<double>(messages_);
}

}  // namespace masked_mapper
