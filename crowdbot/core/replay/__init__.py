"""The replay page: one offline HTML file with runs seen from above and their scores."""
