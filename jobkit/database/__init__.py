"""The database: sessions, tables, and what rows of several resources share."""
