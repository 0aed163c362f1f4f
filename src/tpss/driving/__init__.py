"""What a driver decides: hold the speed limit, meet a lower one, stop at a station."""
