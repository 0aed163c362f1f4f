"""Every run audits itself: balances recomputed from what was recorded."""
