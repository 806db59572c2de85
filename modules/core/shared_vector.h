#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

namespace gnomon {

/// A vector whose copies share their items, page by page, until one of them edits an item (copy on
/// write). Items have the same addresses in all copies that share their page, so which pages of two
/// copies differ is known without a look at the items.
template <typename T> class SharedVector {
public:
	/// Items of a page. An edit copies one page; a comparison costs one pointer a page.
	static constexpr size_t PAGE_SIZE = 8;

	class const_iterator {
	public:
		using iterator_category = std::forward_iterator_tag;
		using value_type = T;
		using difference_type = std::ptrdiff_t;
		using pointer = const T *;
		using reference = const T &;

		const_iterator() = default;
		const_iterator(const SharedVector &p_items, size_t p_index) :
				items(&p_items), index(p_index) {}
		reference operator*() const { return (*items)[index]; }
		pointer operator->() const { return &(*items)[index]; }
		const_iterator &operator++() {
			++index;
			return *this;
		}
		const_iterator operator++(int) {
			const const_iterator before = *this;
			++index;
			return before;
		}
		bool operator==(const const_iterator &) const = default;

	private:
		const SharedVector *items = nullptr;
		size_t index = 0;
	};
	using value_type = T;

	SharedVector() = default;
	// Not movable, so that no vector loses items; a copy is cheap.
	SharedVector(const SharedVector &) = default;
	SharedVector &operator=(const SharedVector &) = default;
	~SharedVector() = default;

	size_t size() const { return count; }
	bool empty() const { return count == 0; }
	const T &operator[](size_t p_index) const {
		return (*pages[p_index / PAGE_SIZE])[p_index % PAGE_SIZE];
	}
	const T &front() const { return (*this)[0]; }
	const T &back() const { return (*this)[count - 1]; }
	const_iterator begin() const { return { *this, 0 }; }
	const_iterator end() const { return { *this, count }; }

	/// Page i has the items from i * PAGE_SIZE on.
	size_t get_page_count() const { return pages.size(); }
	std::span<const T> get_page(size_t p_page) const { return *pages[p_page]; }
	/// True for copies that have not been edited since.
	bool shares_items_with(const SharedVector &p_other) const { return pages == p_other.pages; }
	/// Indices of the pages that it does not share with p_before, ascending; all pages if their
	/// sizes differ.
	std::vector<uint32_t> find_changed_pages(const SharedVector &p_before) const {
		std::vector<uint32_t> changed;
		if (count != p_before.count) {
			changed.resize(pages.size());
			std::iota(changed.begin(), changed.end(), 0u);
			return changed;
		}
		for (uint32_t page = 0; page < pages.size(); ++page) {
			if (pages[page] != p_before.pages[page]) {
				changed.push_back(page);
			}
		}
		return changed;
	}

	void push_back(T p_item) {
		if (count % PAGE_SIZE == 0) {
			pages.push_back(std::make_shared<std::vector<T>>());
			pages.back()->reserve(PAGE_SIZE);
		}
		edit_page(count / PAGE_SIZE).push_back(std::move(p_item));
		++count;
	}
	/// An item, for a change. The reference is valid until the vector is copied.
	T &edit(size_t p_index) { return edit_page(p_index / PAGE_SIZE)[p_index % PAGE_SIZE]; }
	T &edit_back() { return edit(count - 1); }
	/// Calls p_function for each item, for changes.
	template <typename Function> void edit_all(const Function &p_function) {
		for (size_t page = 0; page < pages.size(); ++page) {
			std::ranges::for_each(edit_page(page), p_function);
		}
	}
	/// Shares a page with another vector that has as many items.
	void share_page(size_t p_page, const SharedVector &p_other) {
		pages[p_page] = p_other.pages[p_page];
	}

private:
	std::vector<T> &edit_page(size_t p_page) {
		std::shared_ptr<std::vector<T>> &page = pages[p_page];
		if (page.use_count() > 1) {
			auto copy = std::make_shared<std::vector<T>>();
			copy->reserve(PAGE_SIZE);
			copy->assign(page->begin(), page->end());
			page = std::move(copy);
		}
		// What another thread did with the last other copy, before it dropped that, is done.
		std::atomic_thread_fence(std::memory_order_acquire);
		return *page;
	}

	std::vector<std::shared_ptr<std::vector<T>>> pages;
	size_t count = 0;
};

} // namespace gnomon
