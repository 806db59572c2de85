#pragma once

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

namespace gnomon {

/// A vector whose copies share their items until one of them is edited (copy on write). Items have
/// the same addresses in all copies that share them.
template <typename T> class SharedVector {
public:
	using value_type = T;
	using const_iterator = typename std::vector<T>::const_iterator;

	SharedVector() : items(std::make_shared<std::vector<T>>()) {}
	// Not movable, so that no vector is ever without items; a copy is cheap.
	SharedVector(const SharedVector &) = default;
	SharedVector &operator=(const SharedVector &) = default;
	~SharedVector() = default;

	size_t size() const { return items->size(); }
	bool empty() const { return items->empty(); }
	const T &operator[](size_t p_index) const { return (*items)[p_index]; }
	const T &at(size_t p_index) const { return items->at(p_index); }
	const T &front() const { return items->front(); }
	const T &back() const { return items->back(); }
	const_iterator begin() const { return items->begin(); }
	const_iterator end() const { return items->end(); }
	/// True for copies that have not been edited since.
	bool shares_items_with(const SharedVector &p_other) const { return items == p_other.items; }

	void push_back(T p_item) { edit().push_back(std::move(p_item)); }
	/// The items, for changes. The reference is valid until the vector is copied.
	std::vector<T> &edit() {
		if (items.use_count() > 1) {
			items = std::make_shared<std::vector<T>>(*items);
		}
		// What another thread did with the last other copy, before it dropped that, is done.
		std::atomic_thread_fence(std::memory_order_acquire);
		return *items;
	}

private:
	std::shared_ptr<std::vector<T>> items;
};

} // namespace gnomon
