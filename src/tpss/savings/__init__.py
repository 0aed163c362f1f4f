"""What trains save by using time that they have to spare: energy against minutes, by how they drive."""
