// A vector whose copies share their elements until one of them is written.
#pragma once
#include <atomic>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace palpa {

// Reads as a const std::vector. Copies are cheap; `write` first copies elements that are shared.
// Several threads may own copies; each may be used by one thread at a time.
template <class Value>
class SharedVector {
public:
    using value_type = Value;
    using const_iterator = typename std::vector<Value>::const_iterator;

    SharedVector() = default;
    SharedVector(std::vector<Value> values)
        : values_(std::make_shared<std::vector<Value>>(std::move(values))) {}
    SharedVector(std::initializer_list<Value> values) : SharedVector(std::vector(values)) {}

    // The reference is good until the next copy or write.
    std::vector<Value>& write() {
        if (!values_) values_ = std::make_shared<std::vector<Value>>();
        const bool is_shared = values_.use_count() > 1;
        // Sees all that a thread did with its copy before it let go of it.
        std::atomic_thread_fence(std::memory_order_acquire);
        if (is_shared) values_ = std::make_shared<std::vector<Value>>(*values_);
        return *values_;
    }

    void push_back(Value value) { write().push_back(std::move(value)); }

    const std::vector<Value>& read() const noexcept {
        static const std::vector<Value> none;
        return values_ ? *values_ : none;
    }
    operator const std::vector<Value>&() const noexcept { return read(); }
    const Value& operator[](std::size_t i) const noexcept { return (*values_)[i]; }
    const Value& front() const noexcept { return values_->front(); }
    const Value& back() const noexcept { return values_->back(); }
    const Value* data() const noexcept { return read().data(); }
    std::size_t size() const noexcept { return values_ ? values_->size() : 0; }
    bool empty() const noexcept { return size() == 0; }
    const_iterator begin() const noexcept { return read().begin(); }
    const_iterator end() const noexcept { return read().end(); }
    friend bool operator==(const SharedVector& a, const SharedVector& b) {
        return a.values_ == b.values_ || a.read() == b.read();
    }
    friend bool operator==(const SharedVector& a, const std::vector<Value>& b) {
        return a.read() == b;
    }

    // Memory of the elements, bytes, in equal parts for all that share them.
    std::size_t count_bytes() const noexcept {
        return values_
                   ? values_->size() * sizeof(Value) / static_cast<std::size_t>(values_.use_count())
                   : 0;
    }

private:
    std::shared_ptr<std::vector<Value>> values_;
};

}  // namespace palpa
