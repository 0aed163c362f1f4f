"""Plans of investments: what to build, where and when, under uncertain traffic, at the least cost."""
