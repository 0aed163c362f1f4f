"""The clock: traffic, driver, braking, converters, coupled load flow and motion, step by step."""
