"""The train: its type, its state, what its machine gives, and what it draws from the contact line."""
