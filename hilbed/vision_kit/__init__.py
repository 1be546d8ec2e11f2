"""A detector on rendered frames with truth: datasets, a score, a page, a sweep of what spoils them."""
