"""A detector on rendered frames with truth: datasets of them, a score, a page, a sweep of what spoils them."""
