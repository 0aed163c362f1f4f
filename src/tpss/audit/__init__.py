"""Every run audits itself: balances recomputed from what was recorded, by another way than solved."""
